"""Locks on files, which the system takes back when a process ends, however it ends."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

__all__ = ["held", "is_held", "is_locked_now"]


def is_locked_now(file: IO[bytes]) -> bool:
    """Lock a file until it is closed; False where another process has locked it."""
    try:
        if os.name == "nt":
            import msvcrt

            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined]
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return os.name != "nt"  # a network drive without locks
    return True


@contextmanager
def held(note: Path) -> Iterator[None]:
    """Hold a file that is there, so that others see that whoever wrote it is at work. Not on Windows, where none could
    write to it or remove it meanwhile.
    """
    if os.name == "nt":
        yield
        return
    with note.open("ab") as file:
        is_locked_now(file)
        yield


def is_held(note: Path) -> bool:
    """Whether a process is in :func:`held` with a file."""
    if os.name == "nt":
        return False
    try:
        with note.open("r+b") as file:
            return not is_locked_now(file)
    except OSError:
        return False
