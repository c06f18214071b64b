"""A folder of numbered pictures, with a record by which its frames are known again: only these are ever replaced."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..files import RecordedFiles, StrPath, check_recorded_folder, write_recorded_folder

__all__ = ["RECORD", "check_frame_folder", "frames_in", "is_frame_name", "write_frame_folder"]

RECORD = ".physanimator.json"
"""Name of the record in its folder; hidden, where a leading dot hides."""

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
    return check_recorded_folder(path, _FRAMES, coming=coming)


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
    write_recorded_folder(path, _FRAMES, lambda staging: _written(frames, staging))


def _written(frames: Iterable[NDArray[np.uint8]], staging: Path) -> Iterator[str]:
    from .images import save_image

    for index, frame in enumerate(frames):
        name = _NAME.format(index)
        save_image(staging / name, frame)
        yield name


_FRAMES = RecordedFiles(
    "frames",
    RECORD,
    "no frames but unchanged ones of an earlier clip",
    lambda folder: [frame.name for frame in frames_in(folder)],
)
