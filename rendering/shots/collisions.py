"""Shots that would write over each other, or over what another one reads, however the paths are spelled."""

from __future__ import annotations

import os
import unicodedata
from collections.abc import Callable, Hashable, Iterator, Sequence
from functools import lru_cache

from ..files import is_folder_name
from .problems import Problem
from .shot import Shot, files_read

__all__ = ["colliding_outputs"]

_THIS_COMMAND = "this command"

_Owners = dict[Hashable, set[str]]


def colliding_outputs(
    shots: Sequence[Shot],
    *,
    also_read: Sequence[str],
    also_written: Sequence[tuple[str, str]],
    is_frame: Callable[[str], bool],
) -> list[Problem]:
    """A problem for each result that would take the place of another shot's result or input.

    Args:
        shots: all of the list, in its order.
        also_read: files that the command reads besides, such as the list.
        also_written: options and files that the command writes besides, such as its report.
        is_frame: whether a file of that name in a folder of frames would count as one of them.
    """
    keys = lru_cache(maxsize=None)(lambda path: tuple(_keys(path)))
    readers: _Owners = {key: {_THIS_COMMAND} for path in also_read for key in keys(path)}
    folders: _Owners = {}
    for shot in shots:
        for word in (*shot.paths("input"), *shot.paths("model")):
            for key in {key for file in _files_or_named(word.text or "") for key in keys(file)}:
                readers.setdefault(key, set()).add(shot.name)
        for word in shot.paths("output"):
            if is_folder_name(word.text or ""):
                for key in keys(word.text or ""):
                    folders.setdefault(key, set()).add(shot.name)
    writers: _Owners = {}
    problems = []
    for name, line, option, path in _outputs(shots, also_written):
        place = os.path.realpath(path)
        beside = keys(os.path.dirname(place)) if is_frame(os.path.basename(place)) else ()
        for owners, among, told in (
            (writers, keys(path), "be unlike what {} writes"),
            (readers, keys(path), "not be a file that {} reads"),
            (folders, beside, "not be named as the frames of {} beside it"),
        ):
            others = {owner for key in among for owner in owners.get(key, ())} - {name}
            if others:
                owner = min(others)
                words = told.format(owner if owner == _THIS_COMMAND or owner.startswith("-") else f"shot {owner}")
                shot_name = "" if name == option else name
                problems.append(Problem(f"{option} must {words}. Got: {path}", shot_name, option, line))
                break
        for key in keys(path):
            writers.setdefault(key, set()).add(name)
    return problems


def _outputs(
    shots: Sequence[Shot], also_written: Sequence[tuple[str, str]]
) -> Iterator[tuple[str, int | None, str, str]]:
    """Who writes, the line of it, the option, and the path."""
    for shot in shots:
        for word in shot.paths("output"):
            yield shot.name, shot.lines.get(word.option, shot.line), word.option.replace("_", "-"), word.text or ""
        yield shot.name, shot.line, "output", shot.record
    for option, path in also_written:
        yield option, None, option, path  # no shot's name begins with a dash


def _files_or_named(path: str) -> Iterator[str]:
    """The files of an input, and the input itself: it may be a folder, or not be there yet."""
    yield path
    if os.path.exists(path):
        yield from files_read(path)


def _keys(path: str) -> Iterator[Hashable]:
    """What a path is known by: its real place, what the system knows it by, and its name in its folder."""
    place = os.path.realpath(path)
    yield _folded(place)
    for key in _identity(place):
        yield key
    for key in _identity(os.path.dirname(place)):
        yield (*key, _folded(os.path.basename(place)))


def _identity(path: str) -> Iterator[tuple[int, int]]:
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return
    if status.st_ino:
        yield (status.st_dev, status.st_ino)


def _folded(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()
