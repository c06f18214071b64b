"""Shots that would write over each other, or over what another one reads, however the paths are spelled."""

from __future__ import annotations

import os
import unicodedata
from collections.abc import Callable, Hashable, Iterator, Sequence

from ..files import is_folder_name
from .problems import Problem
from .shot import Shot, files_read

__all__ = ["colliding_outputs"]


def colliding_outputs(
    shots: Sequence[Shot], *, also_read: Sequence[str], is_frame: Callable[[str], bool]
) -> list[Problem]:
    """A problem for each result that would take the place of another shot's result or input.

    Args:
        shots: all of the list, in its order.
        also_read: files that are read besides, such as the list.
        is_frame: whether a file of that name in a folder of frames would count as one of them.
    """
    problems: list[Problem] = []
    read: dict[Hashable, tuple[str, str]] = {}
    for path in also_read:
        read.update((key, ("", path)) for key in _keys(path))
    several: dict[Hashable, set[str]] = {}
    for shot in shots:
        for word in (*shot.paths("input"), *shot.paths("model")):
            for key in {key for file in files_read_or_named(word.text or "") for key in _keys(file)}:
                several.setdefault(key, set()).add(shot.name)
                read.setdefault(key, (shot.name, word.text or ""))
    written: dict[Hashable, tuple[str, str]] = {}
    folders: dict[Hashable, str] = {}
    for shot in shots:
        for word in shot.paths("output"):
            if is_folder_name(word.text or ""):
                folders.update(dict.fromkeys(_keys(word.text or ""), shot.name))
    for shot in shots:
        for option, path in [*((each.option, each.text or "") for each in shot.paths("output")), ("", shot.record)]:
            written_option = option.replace("_", "-")
            keys = list(_keys(path))
            other = next((written[key] for key in keys if key in written and written[key][0] != shot.name), None)
            reader = next((key for key in keys if key in read and several.get(key, {""}) != {shot.name}), None)
            if other is not None:
                told = f"must be unlike what shot {other[0]} writes. Got: {path}"
                problems.append(Problem(f"{written_option or 'output'} {told}", shot.name, written_option, shot.line))
            elif reader is not None:
                who = f"shot {_other(several.get(reader, set()), shot.name)}" if reader in several else "this command"
                told = f"{written_option or 'output'} must not be a file that {who} reads. Got: {path}"
                problems.append(Problem(told, shot.name, written_option, shot.line))
            elif is_frame(os.path.basename(os.path.realpath(path))):
                above = _keys(os.path.dirname(os.path.realpath(path)))
                holder = next((folders[key] for key in above if key in folders), shot.name)
                if holder != shot.name:
                    told = f"{written_option} must not be named as the frames of shot {holder} beside it. Got: {path}"
                    problems.append(Problem(told, shot.name, written_option, shot.line))
            for key in keys:
                written.setdefault(key, (shot.name, path))
    return problems


def _other(names: set[str], own: str) -> str:
    return min(names - {own}, default=own)


def files_read_or_named(path: str) -> Iterator[str]:
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
