"""The hidden folder in which a run notes what is under way, and that it is the only one there."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ...physics.errors import InvalidInputError
from .job import forget_runs, notes_of
from .locks import is_locked_now
from .problems import Problem
from .shot import Shot
from .shot_record import described, read_shot_record

__all__ = ["NOTES", "alone_in", "forgetting", "others_files"]

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
        if not is_locked_now(lock):
            raise InvalidInputError(
                f"--output must be a folder that no other run fills. Got: {out}, where one is at work"
            )
        try:
            yield
        finally:
            lock.close()
            with suppress(OSError):  # there are notes of others, such as of the lines of a farm
                (notes / "lock").unlink()
                notes.rmdir()


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


def others_files(out: str, shots: Iterable[Shot], *, lists: str) -> Iterator[Problem]:
    """Clips that would be replaced, of which neither a record, which knows them as they are, nor the note of a killed
    run says that a run of the same list wrote them.

    Args:
        out: the folder of results.
        shots: that are to be done.
        lists: the folder of their list. One that has left it, such as by another name, makes room for this.
    """
    notes = Path(out, NOTES)
    for shot in shots:
        if any(note.exists() for note in notes_of(notes, shot)):
            continue
        for word in shot.paths("output"):
            path = word.text or ""
            told = _of_another_list(shot, path, lists) if os.path.exists(path) else None
            if told is None and os.path.isfile(path):
                told = _of_others(shot, word.option, path)
            if told is not None:
                line = shot.lines.get(word.option, shot.line)
                yield Problem(f"{word.option} must be {told}", shot.name, word.option, line)


def _of_another_list(shot: Shot, path: str, lists: str) -> str | None:
    """What a message says of what was made for another list, where a shot of the same name is; None of the rest."""
    record = read_shot_record(shot.record)
    if record is None or not record.listed or record.listed.casefold() == shot.listed.casefold():
        return None
    if not os.path.exists(os.path.join(lists, record.listed)):
        return None
    return f"new, or a clip of {shot.listed}. Got: {path}, which {record.listed} has made"


def _of_others(shot: Shot, option: str, path: str) -> str | None:
    """What a message says of a file that somebody else has written, or changed since; None of one that is ours."""
    if not os.path.lexists(shot.record):
        if option != "output":  # its name is in the list
            return None
        return f"new, or a clip with its record beside it. Got: {path}, which no run has written"
    record = read_shot_record(shot.record)
    if record is None or described(record, shot, path):
        return None
    return f"as a run has left it; move it away, or remove it to have it made again. Got: {path}, which has changed"
