"""Files and folders under work: hidden beside the place that they are for, and never left behind."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path

from .signals import clearing_up, uninterrupted

__all__ = ["made_beside", "noting_unfinished", "remove_noted", "remove_unfinished", "removed_at_signals"]

_TRIES = 200  # random names, before giving up
_PREFIX = 5  # characters of the name that give way to a dot and a random number

_unfinished: dict[Path, int] = {}  # by the process that makes it: a fork knows of it as well, and must not touch it
_note: ContextVar[Path | None] = ContextVar("note", default=None)


@contextmanager
def made_beside(name: str, folder: Path, *, is_folder: bool = False) -> Iterator[Path]:
    """A new, empty file or folder that nobody else has, gone at the end if it is still there.

    Its own name is hidden and not longer than ``name``, and ends like it where there is room.

    Args:
        name: of what shall replace or become it.
        folder: where to make it.
        is_folder: whether a folder is wanted.

    Raises:
        OSError: it cannot be made.
    """
    with removed_at_signals():
        made: Path | None = None
        try:
            with uninterrupted():
                made = _made(name, folder, is_folder)
                _unfinished[made] = os.getpid()
                _write_down(made)
            yield made
        finally:
            with uninterrupted():
                if made is not None:
                    _remove(made)


def removed_at_signals() -> AbstractContextManager[None]:
    """Let a signal that nobody handles remove what is made inside, on whatever thread, before it ends the process.

    Only the main thread can do so; it is the one to enter this while another one writes for it.
    """
    return clearing_up(remove_unfinished)


@contextmanager
def noting_unfinished(note: Path) -> Iterator[None]:
    """Write down what is made inside, on this thread, so that others can remove it should the process be killed.

    Args:
        note: a text file, gone at the end unless the process is killed before.
    """
    token = _note.set(note)
    try:
        yield
    finally:
        _note.reset(token)
        with suppress(OSError):
            note.unlink(missing_ok=True)


def remove_noted(note: Path) -> None:
    """Remove what a killed process has left, by what it wrote down, and the note itself."""
    try:
        names = note.read_text(encoding="utf-8", errors="surrogateescape").split("\0")
    except OSError:
        return
    for name in names:
        made = Path(name)
        if made.is_absolute() and made.name.startswith(".") and os.path.lexists(made):
            _remove(made)
    with suppress(OSError):
        note.unlink(missing_ok=True)


def _write_down(made: Path) -> None:
    note = _note.get()
    if note is not None:
        with note.open("a", encoding="utf-8", errors="surrogateescape") as file:
            file.write(f"{os.path.abspath(made)}\0")


def remove_unfinished() -> None:
    """Remove everything that this process made and is neither in its place nor removed: it is ending."""
    for made, process in list(_unfinished.items()):
        if process == os.getpid():
            _remove(made)


def _remove(made: Path) -> None:
    _unfinished.pop(made, None)
    if os.path.isdir(made) and not os.path.islink(made):
        shutil.rmtree(_out_of_reach(made), ignore_errors=True)
    else:
        with suppress(OSError):
            made.unlink(missing_ok=True)


def _out_of_reach(folder: Path) -> Path:
    """The folder under another name, so that threads that still write into it by its own add nothing meanwhile."""
    away = folder.with_name(f".{secrets.token_hex(8)}")
    try:
        os.rename(folder, away)
    except OSError:
        return folder
    return away


def _made(name: str, folder: Path, is_folder: bool) -> Path:
    for _ in range(_TRIES):
        place = folder / f".{secrets.token_hex(2)}{name[_PREFIX:]}"
        try:
            if is_folder:
                place.mkdir()
            else:
                os.close(os.open(place, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        except FileExistsError:
            continue
        return place
    raise FileExistsError(f"{folder} holds too many unfinished files")
