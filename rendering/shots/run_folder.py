"""The hidden folder in which a run notes what is under way, and that it is the only one there."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from ...physics.errors import InvalidInputError
from .job import forget_runs
from .shot import Shot

__all__ = ["NOTES", "alone_in", "forgetting"]

NOTES = ".shots"
"""Name of the folder."""


@contextmanager
def alone_in(out: str) -> Iterator[None]:
    """The one run that fills a folder of results; the system ends this with the process, however that ends.

    Raises:
        InvalidInputError: another run does so already.
    """
    notes = Path(out, NOTES)
    notes.mkdir(exist_ok=True)
    with (notes / "lock").open("a+b") as lock:
        if not _locked(lock):
            raise InvalidInputError(
                f"--output must be a folder that no other run fills. Got: {out}, where one is at work"
            )
        try:
            yield
        finally:
            with suppress(OSError):
                lock.close()
                shutil.rmtree(notes)


@contextmanager
def forgetting(out: str, shots: list[Shot]) -> Iterator[None]:
    """Before and after a run, remove what killed workers have left."""
    notes = Path(out, NOTES)

    def forget() -> None:
        if notes.is_dir():
            for shot in shots:
                forget_runs(notes, shot)

    forget()
    try:
        yield
    finally:
        forget()
        with suppress(OSError):
            notes.rmdir()


def _locked(file: IO[bytes]) -> bool:
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
