"""Which options name files, and that nothing is written over what is read or over another result."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from ..physics.errors import InvalidInputError
from .frame_folder import frames_in
from .frame_record import RECORD
from .places import is_folder_name, place_of, printable, same_name

__all__ = ["INPUTS", "OUTPUTS", "check_apart", "named"]

INPUTS = (
    "image",
    "mask",
    "points",
    "scene",
    "collider",
    "plate",
    "clip",
    "reference",
    "fid",
    "video_score",
)
"""Every option that names something to read, as the parser calls it."""

OUTPUTS = ("output", "save_sketch", "save_flow", "preview", "save_tracks", "save_motion", "save_svg")
"""Every option that names something to write."""

_Identity = tuple[int, int]


def named(options: argparse.Namespace, names: Sequence[str]) -> Iterator[tuple[str, str]]:
    """The paths that options give, each with how a person calls the option."""
    for name in names:
        given = getattr(options, name, None)
        spelled = "IMAGE" if name == "image" else "--" + name.replace("_", "-")
        for path in given if isinstance(given, list) else [given]:
            if path is not None:
                yield spelled, path


def check_apart(options: argparse.Namespace, *, bundled: Sequence[Path] = ()) -> None:
    """Refuse results that would take the place of an input or of one another, however their paths are spelled.

    Args:
        options: of a command.
        bundled: files that the command reads without being told.

    Raises:
        InvalidInputError: the message names both.
    """
    outputs = list(named(options, OUTPUTS))
    inputs = [*named(options, INPUTS), *(("the bundled example", os.fspath(path)) for path in bundled)]
    read = {identity: each for each in inputs if (identity := _identity(Path(each[1]))) is not None}
    for option, path in outputs:
        for place in _replaced(path):
            identity = _identity(place)
            if identity in read:
                source, name = read[identity]
                raise InvalidInputError(
                    f"{option} must not be a file that is read. Got: {printable(path)}, which would replace"
                    f" {printable(name)} ({source})"
                )
    _check_distinct(outputs)


def _replaced(path: str) -> Iterator[Path]:
    """What is there and would go."""
    place = place_of(path)
    if not (is_folder_name(path) and os.path.isdir(place)):
        yield place
        return
    yield from frames_in(place)
    yield place / RECORD


def _check_distinct(outputs: Sequence[tuple[str, str]]) -> None:
    for number, (option, path) in enumerate(outputs):
        for other, earlier in outputs[:number]:
            if _collide(path, earlier):
                both = f"{other} {printable(earlier)}, {option} {printable(path)}"
                raise InvalidInputError(f"every output must have its own name. Got: {both}")


def _collide(first: str, second: str) -> bool:
    one, two = place_of(first), place_of(second)
    if same_name(str(one), str(two)):
        return True
    identity = _identity(one)
    if identity is not None and identity == _identity(two):
        return True
    beside = _identity(one.parent)
    if beside is not None and beside == _identity(two.parent) and same_name(one.name, two.name):
        return True
    return any(_is_record(place, folder) for place, folder in ((one, second), (two, first)))


def _is_record(place: Path, folder: str) -> bool:
    """Whether a file is the record of the folder of frames that is also written."""
    return is_folder_name(folder) and same_name(place.name, RECORD) and place.parent == place_of(folder)


def _identity(path: Path) -> _Identity | None:
    """What the system knows a file by, whatever its names; None where there is none."""
    try:
        status = path.stat()
    except (OSError, ValueError):
        return None
    return (status.st_dev, status.st_ino) if status.st_ino else None
