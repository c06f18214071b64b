"""A folder of numbered pictures, with a record by which its frames are known again: only these are ever replaced."""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ..files import (
    StrPath,
    check_folder_place,
    check_replaceable,
    is_read_only,
    made_beside,
    naming_place,
    place_of,
    putting_in_place,
    uninterrupted,
)
from .frame_record import RECORD, Record, WrittenFrame, read_record, recorded, write_record

__all__ = ["check_frame_folder", "frames_in", "is_frame_name", "write_frame_folder"]

_NAME = "frame_{:04d}.png"
_PATTERN = re.compile(r"frame_[0-9]{4,}\.png", re.IGNORECASE)


def check_frame_folder(path: StrPath, *, coming: Collection[Path] = ()) -> Path:
    """Refuse a folder that could not be written, or holds frames that :func:`write_frame_folder` did not write.

    Args:
        path: the folder, which need not exist yet.
        coming: see :func:`~physanimator.rendering.files.check_file_place`.

    Returns:
        Where it really comes to lie.

    Raises:
        InvalidInputError: see above.
    """
    place = check_folder_place(path, coming=coming)
    if os.path.isdir(place):
        _record_of(place, path)
        check_replaceable(place / RECORD)
    return place


def is_frame_name(name: str) -> bool:
    """Whether a file of this name in a folder of frames would count as one of them."""
    return _PATTERN.fullmatch(name) is not None


def frames_in(folder: Path) -> list[Path]:
    """All files in a folder that are named as frames are, whoever wrote them."""
    return sorted(entry for entry in folder.iterdir() if is_frame_name(entry.name))


def write_frame_folder(frames: Iterable[NDArray[np.uint8]], path: StrPath) -> None:
    """Write frames as ``frame_0000.png`` and so on; they appear, and earlier ones go, when all are complete.

    Args:
        frames: pictures of one size, in turn.
        path: the folder, which is made if it does not exist.

    Raises:
        InvalidInputError: see :func:`check_frame_folder`.
        OSError: the disk is full or the like; it names ``path``.
    """
    place = place_of(path)
    inside = os.path.isdir(place)
    name, parent = (".frames", place) if inside else (place.name, place.parent)
    with naming_place(path), made_beside(name, parent, is_folder=True) as staging:
        record = _written(frames, staging)
        with uninterrupted(), putting_in_place(path):
            if inside:
                _exchange(place, staging, record, path)
            else:
                staging.rename(place)


def _written(frames: Iterable[NDArray[np.uint8]], staging: Path) -> Record:
    from .images import save_image

    record = []
    for index, frame in enumerate(frames):
        picture = staging / _NAME.format(index)
        save_image(picture, frame)
        record.append(recorded(picture))
    write_record(staging, record)
    return record


def _record_of(folder: Path, path: StrPath) -> Record:
    """What the record says of the frames in a folder, all of which it must know.

    Raises:
        InvalidInputError: it does not.
    """
    record = read_record(folder)
    if record is None:
        raise InvalidInputError(
            f"folder {path} must have a readable record of its frames. Got: a damaged {RECORD}; choose another folder"
        )
    known: dict[str, list[WrittenFrame]] = {}
    for each in record:
        known.setdefault(each.name, []).append(each)
    for frame in frames_in(folder):
        described = any(each.describes(frame) for each in known.get(frame.name, ()))
        if described and not is_read_only(frame.stat()):
            continue
        changed = "is read-only" if described else "was changed after it was written"
        reason = changed if frame.name in known else "PhysAnimator did not write"
        raise InvalidInputError(
            f"folder {path} must hold no frames but unchanged ones of an earlier clip."
            f" Got: {frame.name}, which {reason}; choose another folder"
        )
    return record


def _exchange(folder: Path, staging: Path, record: Record, path: StrPath) -> None:
    """Take the earlier frames away, then put the new ones in their place: never both are there.

    While this lasts the record knows both, so that the frames are known again should the machine stop in the middle.
    An error puts everything back.
    """
    present = frames_in(folder)
    earlier = _record_of(folder, path)
    aside = staging / "earlier"
    aside.mkdir()
    write_record(folder, [*earlier, *record])
    moved: list[tuple[Path, Path]] = []

    def move(source: Path, target: Path) -> None:
        if os.path.lexists(target):
            raise FileExistsError(errno.EEXIST, f"{target.name} has appeared meanwhile")
        source.rename(target)
        moved.append((source, target))

    try:
        for frame in present:
            move(frame, aside / frame.name)
        for each in record:
            move(staging / each.name, folder / each.name)
        write_record(folder, record)
    except BaseException:
        _put_back(folder, moved, earlier)
        raise


def _put_back(folder: Path, moved: Sequence[tuple[Path, Path]], earlier: Record) -> None:
    for source, target in reversed(moved):
        target.rename(source)
    if earlier:
        write_record(folder, earlier)
    else:
        (folder / RECORD).unlink()
