"""What a worker gets to do, and what it answers; and the doing itself."""

from __future__ import annotations

import os
import platform
import time
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ...physics.errors import Cancelled
from ...physics.interruption import interruptible
from ..files import is_full, noting_unfinished, remove_noted
from .locks import held, is_held
from .shot import FileDigests, Shot, identity_of
from .shot_record import (
    ShotRecord,
    described,
    is_finished,
    read_shot_record,
    write_shot_record,
    written_by,
)

__all__ = [
    "FAULT",
    "MOST_RUNS",
    "Animated",
    "Job",
    "Outcome",
    "animated",
    "as_now",
    "forget_runs",
    "notes_of",
    "outcome_of",
    "perform",
    "record_of",
]

FAULT = 70
"""Status of a shot that an error of ours has ended, as sysexits.h has it."""

MOST_RUNS = 3
"""How often a shot is begun in all when the workers that do it are killed."""


_POLL = 0.2  # [s]
_CHANGED = "what it reads was changed meanwhile; the same command does it again"


@dataclass(frozen=True)
class Animated:
    """How the command of a shot ended.

    Attributes:
        status: as an exit status.
        said: its lines for a person.
        full: whether the disk takes no more.
    """

    status: int
    said: tuple[str, ...] = ()
    full: bool = False


@dataclass(frozen=True)
class Outcome:
    """What became of a shot.

    Attributes:
        name: of the shot.
        state: "done", "kept" (it was done before), "failed", "lost" (its workers were killed) or "left" (not begun).
        why: a sentence, where it is not done.
        seconds: that it took [s].
        machine: where.
        said: what the command has said.
        full: whether the disk takes no more.
    """

    name: str
    state: str
    why: str = ""
    seconds: float = 0.0
    machine: str = ""
    said: tuple[str, ...] = ()
    full: bool = False

    @property
    def is_good(self) -> bool:
        """Whether its results are there."""
        return self.state in ("done", "kept")


@dataclass(frozen=True)
class Job:
    """A shot as it travels to a worker.

    Attributes:
        shot: what to do.
        identity: see :func:`~physanimator.rendering.shots.shot.identity_of`.
        run: does it: called with the words of the command; stops at its next checkpoint where nobody wants it any more.
        files_of: the files that were written of an output.
        notes: folder in which a worker writes down what it has begun.
    """

    shot: Shot
    identity: str
    run: Callable[[Sequence[str]], Animated]
    files_of: Callable[[str], Sequence[str]]
    notes: str


def as_now(job: Job) -> Job:
    """The job with the identity that its files give it now; as it is where one of them cannot be read."""
    try:
        return replace(job, identity=identity_of(job.shot, FileDigests()))
    except OSError:
        return job


def perform(job: Job, wanted: Callable[[], bool] = lambda: True, *, waits: bool = False) -> Outcome:
    """Do a shot where its files are, and write its record.

    Args:
        job: what to do.
        wanted: whether anybody still waits for it; asked now and then.
        waits: where another process does the very shot, wait for it to end first.
    """
    while waits and any(is_held(note) for note in notes_of(Path(job.notes), job.shot)):
        time.sleep(_POLL)
    job = as_now(job)  # somebody may have painted since the list was read
    shot, machine = job.shot, platform.node()
    kept = is_finished(shot, job.identity)
    if kept is not None:  # by a worker that was killed before it could say so
        return Outcome(shot.name, "done", seconds=kept.seconds, machine=kept.machine, said=kept.said)
    try:
        run = _begun(Path(job.notes), shot)
    except OSError as error:
        return Outcome(shot.name, "failed", told_of(error), machine=machine, full=is_full(error))
    if run is None:
        return Outcome(shot.name, "lost", f"its worker was killed {MOST_RUNS} times", machine=machine)
    start = time.perf_counter()
    with held(run), noting_unfinished(run):
        ended = animated(job.run, shot.command(), wanted)
        outcome = outcome_of(shot, ended, time.perf_counter() - start, machine)
        return _recorded(job, outcome) if outcome.state == "done" else outcome


def _recorded(job: Job, outcome: Outcome) -> Outcome:
    """Write the record of a shot that is done; of one whose files have changed meanwhile such that it is done again."""
    same = as_now(job).identity == job.identity
    try:
        record_of(job if same else replace(job, identity=""), outcome)
    except (OSError, ValueError) as error:
        return replace(outcome, state="failed", why=told_of(error), full=is_full(error))
    return outcome if same else replace(outcome, state="failed", why=_CHANGED)


def animated(run: Callable[[Sequence[str]], Animated], words: Sequence[str], wanted: Callable[[], bool]) -> Animated:
    """Run the command of a shot, whatever it raises."""

    def check() -> None:
        if not wanted():
            raise Cancelled("nobody waits for it any more")

    try:
        with interruptible(check):
            return run(words)
    except Exception as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        where = f"{os.path.basename(last.filename)}, line {last.lineno}"
        return Animated(FAULT, (f"{type(error).__name__}: {error} (an error of PhysAnimator itself, in {where})",))


def outcome_of(shot: Shot, ended: Animated, seconds: float, machine: str) -> Outcome:
    """What became of a shot by how its command ended."""
    if ended.status == 0:
        return Outcome(shot.name, "done", "", seconds, machine, ended.said)
    why = ended.said[-1] if ended.said else f"exit status {ended.status}"
    return Outcome(shot.name, "failed", why, seconds, machine, ended.said[:-1], ended.full)


def record_of(job: Job, outcome: Outcome) -> None:
    """Write the record of a shot that is done. Where that fails, its clip goes too: nobody would know whose it is.

    Raises:
        OSError: it cannot be written, or a result is not there.
    """
    shot = job.shot
    settings, said = dict(shot.settings), outcome.said
    try:
        files = written_by(shot.record, [each.text or "" for each in shot.paths("output")], job.files_of)
        record = ShotRecord(
            shot.name, job.identity, files, outcome.seconds, outcome.machine, said, settings, listed=shot.listed
        )
        write_shot_record(shot.record, record)
    except OSError:
        earlier = read_shot_record(shot.record)
        clips = [each.text or "" for each in shot.paths("output") if each.option == "output"]
        for file in (file for clip in clips for file in job.files_of(clip)):
            if earlier is None or not described(earlier, shot, file):  # nobody else has made the same meanwhile
                Path(file).unlink(missing_ok=True)
        raise


def told_of(error: Exception) -> str:
    """An error of the disk, or another, in a sentence."""
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    return str(error)


def _begun(notes: Path, shot: Shot) -> Path | None:
    """The note of this run; None where earlier runs were killed too often. What they have left is removed."""
    for note in notes_of(notes, shot):
        if not note.exists():
            _touch(note)
            return note
        if is_held(note):  # by a run that is at work
            continue
        remove_noted(note)
        _touch(note)  # it counts
    return None


def _touch(note: Path) -> None:
    """Make a note, again where another run has just tidied up its folder."""
    for last in (False, True):
        note.parent.mkdir(exist_ok=True)
        try:
            note.touch()
            return
        except FileNotFoundError:
            if last:
                raise


def forget_runs(notes: Path, shot: Shot) -> None:
    """Remove what runs of a shot have left that were killed, and the memory of them."""
    for note in notes_of(notes, shot):
        if not is_held(note):
            remove_noted(note)


def notes_of(notes: Path, shot: Shot) -> list[Path]:
    """Where runs of a shot note that they have begun; those that are there are of runs that were killed."""
    return [notes / f"{shot.name}.{run}" for run in range(MOST_RUNS)]
