"""The hidden folder in which a run notes what is under way, and that it is the only one there."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ...physics.errors import InvalidInputError
from .job import forget_runs, notes_of
from .locks import is_locked_now
from .problems import Problem
from .shot import Shot

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


def others_files(out: str, shots: Iterable[Shot]) -> Iterator[Problem]:
    """Files that would be replaced, of which neither a record nor the note of a killed run says that a run wrote them.

    Args:
        out: the folder of results.
        shots: that are to be done.
    """
    notes = Path(out, NOTES)
    for shot in shots:
        if os.path.lexists(shot.record) or any(note.exists() for note in notes_of(notes, shot)):
            continue
        clips = (each.text or "" for each in shot.paths("output") if each.option == "output")
        for path in filter(os.path.isfile, clips):
            told = f"output must be new, or a clip with its record beside it. Got: {path}, which no run has written"
            yield Problem(told, shot.name, "output", shot.lines.get("output", shot.line))
