"""Which options name files, and that nothing is written over what is read or over another result."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

from ...physics.errors import InvalidInputError
from ..export import SPINE_RECORD, is_spine_name, spine_files_in
from ..files import is_folder_name, place_of, same_name
from ..pictures import RECORD, frames_in, is_frame_name
from .names import named_as, option_of

__all__ = ["CLIPS", "INPUTS", "MODELS", "OUTPUTS", "check_apart", "coming_folders", "named", "writing_order"]

MODELS = (
    "svd",
    "lvcd",
    "inpainting",
    "tooncrafter",
    "sketch_encoder",
    "image_encoder",
    "text_encoder",
    "lines",
    "sam",
)
"""Every option that names weights."""

INPUTS = (
    "image",
    "file",
    "mask",
    "in_front",
    "points",
    "scene",
    "collider",
    "plate",
    "clip",
    "reference",
    "fid",
    "video_score",
    *MODELS,
)
"""Every option that names something to read, as the parser calls it."""

CLIPS = ("output", "save_sketch", "save_flow", "preview")
"""Every option that names a clip to write: a file, or a folder of frames."""

OUTPUTS = (
    *CLIPS,
    "save_spine",
    "save_vectors",
    "save_tracks",
    "save_motion",
    "save_svg",
    "save_scene",
    "save_uncovered",
    "save_plate",
    "save_gltf",
    "save_psd",
    "save_png",
)
"""Every option that names something to write."""

_SPINE = "save_spine"

_Identity = tuple[int, int]

_MOST_READ = 20_000  # files of a folder that are looked at: more frames than a clip may have


def named(options: argparse.Namespace, names: Sequence[str]) -> Iterator[tuple[str, str]]:
    """The paths that options give, each with how a person calls the option."""
    for name in names:
        given = getattr(options, name, None)
        for path in given if isinstance(given, list) else [given]:
            if path is not None:
                yield option_of(name), path


def writing_order(options: argparse.Namespace) -> list[str]:
    """The options of clips and skeletons to write, as the parser calls them: folders before what may be in them."""
    asked = [name for name in (*CLIPS, _SPINE) if getattr(options, name, None) is not None]
    folders = [name for name in asked if name == _SPINE or is_folder_name(getattr(options, name))]
    folders.sort(key=lambda name: len(place_of(getattr(options, name)).parts))
    return folders + [name for name in asked if name not in folders]


def coming_folders(options: argparse.Namespace) -> frozenset[Path]:
    """The folders that a command fills: other results may be written into them, even where they are new."""
    clips = [path for _, path in named(options, CLIPS) if path and is_folder_name(path)]
    others = [path for _, path in named(options, (_SPINE, "save_vectors")) if path]
    return frozenset(map(place_of, clips + others))


def check_apart(options: argparse.Namespace, *, bundled: Sequence[Path] = ()) -> None:
    """Refuse results that would take the place of an input or of one another, however their paths are spelled.

    Args:
        options: of a command.
        bundled: files that the command reads without being told.

    Raises:
        InvalidInputError: the message names both.
    """
    outputs = list(named(options, OUTPUTS))
    for option, path in outputs:
        with named_as(option, "output"):
            place_of(path)
    given = [(option, path) for option, each in named(options, INPUTS) for path in _read(each)]
    inputs = [*given, *(("the bundled example", os.fspath(path)) for path in bundled)]
    read = {identity: each for each in inputs if (identity := _identity(Path(each[1]))) is not None}
    for option, path in outputs:
        for place in _replaced(path, spine=option == option_of(_SPINE)):
            identity = _identity(place)
            if identity in read:
                source, name = read[identity]
                raise InvalidInputError(
                    f"{option} must not be a file that is read. Got: {path}, which would replace {name} ({source})"
                )
    _check_distinct(outputs)
    _check_among_frames(outputs)
    _check_among_skeletons(outputs)


def _read(path: str) -> Iterator[str]:
    """What is read of a path: the file, or the folder and what lies in it and in its folders."""
    yield path
    if os.path.isdir(path):
        inside = (os.path.join(folder, name) for folder, _, names in os.walk(path) for name in names)
        yield from islice(inside, _MOST_READ)


def _check_among_frames(outputs: Sequence[tuple[str, str]]) -> None:
    """Refuse a result that has a frame's name in a folder of frames which is written, too."""
    folders = {place_of(path) for _, path in outputs if is_folder_name(path)}
    for option, path in outputs:
        place = place_of(path)
        if place.parent in folders and is_frame_name(place.name):
            raise InvalidInputError(f"{option} must not be named as the frames beside it are. Got: {path}")


def _check_among_skeletons(outputs: Sequence[tuple[str, str]]) -> None:
    """Refuse a result that has the name of a skeleton's file, or lies among its images, where one is written, too."""
    for folder in [place_of(path) for option, path in outputs if option == option_of(_SPINE)]:
        for option, path in outputs:
            place = place_of(path)
            within = place.is_relative_to(folder) and place != folder
            if within and is_spine_name(folder, place.relative_to(folder).as_posix()):
                raise InvalidInputError(f"{option} must not be named as the skeleton's files are. Got: {path}")


def _replaced(path: str, *, spine: bool = False) -> Iterator[Path]:
    """What is there and would go."""
    place = place_of(path)
    if spine and os.path.isdir(place):
        yield place  # of layers: the skeleton's pictures would be among them
        yield from (place / name for name in spine_files_in(place))
        yield place / SPINE_RECORD
        return
    if not (is_folder_name(path) and os.path.isdir(place)):
        yield place
        return
    yield from frames_in(place)
    yield place / RECORD


def _check_distinct(outputs: Sequence[tuple[str, str]]) -> None:
    for number, (option, path) in enumerate(outputs):
        for other, earlier in outputs[:number]:
            if _collide(path, earlier):
                both = f"{other} {earlier}, {option} {path}"
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
