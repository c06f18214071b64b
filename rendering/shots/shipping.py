"""Shots on machines that share no disk: files travel with the work, and results come back with the answer."""

from __future__ import annotations

import os
import platform
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..files import made_beside, noting_unfinished, replacing, uninterrupted
from .job import Job, Outcome, animated, notes_of, outcome_of, record_of
from .shot import files_read

__all__ = ["Parcel", "Returned", "packed", "perform_elsewhere", "unpacked"]


@dataclass(frozen=True)
class Parcel:
    """What a shot reads.

    Attributes:
        folders: inputs that are folders.
        files: content of every file, by the input that it belongs to and its path from there on; empty for the input.
    """

    folders: tuple[str, ...]
    files: Mapping[tuple[str, str], bytes]


@dataclass(frozen=True)
class Returned:
    """What a worker answers.

    Attributes:
        outcome: what became of the shot.
        files: content of what was written, by the output that it belongs to and its path from there on.
    """

    outcome: Outcome
    files: Mapping[tuple[str, str], bytes]


def packed(job: Job) -> Parcel:
    """Everything that a shot reads, but for weights of networks.

    Raises:
        OSError: a file cannot be read.
    """
    folders, files = [], {}
    for word in job.shot.paths("input"):
        path = word.text or ""
        if not os.path.exists(path):
            continue
        if os.path.isdir(path):
            folders.append(path)
        for file in files_read(path):
            top = path if os.path.isdir(path) else os.path.dirname(path)
            within = os.path.relpath(file, top) if file != path else ""
            files[path, within] = Path(file).read_bytes()
    return Parcel(tuple(folders), files)


def perform_elsewhere(job: Job, parcel: Parcel, wanted: Callable[[], bool], *, folder: str | None = None) -> Returned:
    """Do a shot in a folder of its own, which is gone afterwards.

    Args:
        job: what to do.
        parcel: what it reads.
        wanted: whether anybody still waits for it; asked now and then.
        folder: where to make that folder; None among the temporary files.
    """
    with tempfile.TemporaryDirectory(prefix="physanimator-shot-", dir=folder, ignore_cleanup_errors=True) as top:
        places = _laid_out(parcel, Path(top, "in"))
        for number, word in enumerate(job.shot.paths("output")):
            folder_of_one = Path(top, "out", str(number))
            folder_of_one.mkdir(parents=True)
            places[word.text or ""] = _inside(folder_of_one, word.text or "")
        start = time.perf_counter()
        ended = animated(job.run, job.shot.command(places), wanted)
        there = {place: path for path, place in places.items()}
        said = tuple(_as_here(line, there) for line in ended.said)
        ended = type(ended)(ended.status, said, ended.full)
        outcome = outcome_of(job.shot, ended, time.perf_counter() - start, platform.node())
        files: dict[tuple[str, str], bytes] = {}
        if outcome.state == "done":
            for word in job.shot.paths("output"):
                place = places[word.text or ""]
                for file in job.files_of(place):
                    files[word.text or "", _within(file, place)] = Path(file).read_bytes()
        return Returned(outcome, files)


def _as_here(line: str, there: Mapping[str, str]) -> str:
    """A line with the paths that its reader knows."""
    for place, path in there.items():
        line = line.replace(place.rstrip("/\\"), path.rstrip("/\\"))
    return line


def _laid_out(parcel: Parcel, top: Path) -> dict[str, str]:
    """The files in a folder, and where each input is now."""
    places: dict[str, str] = {}
    for path, within in parcel.files:
        if path not in places:
            place = top / str(len(places))
            place.mkdir(parents=True)
            places[path] = _inside(place, path)
        goal = Path(places[path])
        if within:
            goal = Path(goal if path in parcel.folders else goal.parent, within)
        goal.parent.mkdir(parents=True, exist_ok=True)
        goal.write_bytes(parcel.files[path, within])
    return places


def _inside(place: Path, path: str) -> str:
    """A path of the same name in another folder; that of a folder ends as it did."""
    bare = path.rstrip("/\\" if os.name == "nt" else "/")
    return os.path.join(place, os.path.basename(bare)) + path[len(bare) :]


def _within(file: str, place: str) -> str:
    real, top = os.path.realpath(file), os.path.realpath(place)
    return "" if real == top else os.path.relpath(real, top)


def unpacked(job: Job, returned: Returned) -> Outcome:
    """Put what has come back in its place, and write the record.

    Raises:
        InvalidInputError: something cannot be replaced.
        OSError: the disk is full or the like.
    """
    outcome = returned.outcome
    if outcome.state != "done":
        return outcome
    note = notes_of(Path(job.notes), job.shot)[0]
    note.parent.mkdir(exist_ok=True)
    note.touch()
    with noting_unfinished(note):
        for path in dict.fromkeys(path for path, _ in returned.files):
            mine = {within: content for (each, within), content in returned.files.items() if each == path}
            if "" in mine:
                with replacing(path) as temporary:
                    temporary.write_bytes(mine[""])
            else:
                _put_folder(Path(path), mine, job.files_of(path))
        record_of(job, outcome)
    return outcome


def _put_folder(folder: Path, files: Mapping[str, bytes], earlier: Sequence[str]) -> None:
    """Files of a folder, complete, in the place of those of an earlier run."""
    with made_beside(folder.name, folder.parent, is_folder=True) as staging:
        for within, content in files.items():
            goal = staging / within
            goal.parent.mkdir(parents=True, exist_ok=True)
            goal.write_bytes(content)
        with uninterrupted():
            for file in earlier:
                os.unlink(file)
            for within in files:
                goal = folder / within
                goal.parent.mkdir(parents=True, exist_ok=True)
                os.replace(staging / within, goal)
