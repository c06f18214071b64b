"""Clips on disk: a folder each, that appears whole, is known again by what it was made from, and is only ours."""

from __future__ import annotations

import json
import os
import re
import shutil
import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ..files import RecordedFiles, check_recorded_folder, write_recorded_folder, write_text
from ..files.record import read_record
from ..pictures import read_clip, write_animation
from ..pictures.container_formats import ContainerFormat
from ..pictures.encoding import encode
from ..pictures.frame_rates import exact_frame_rate

__all__ = ["EXACT", "SHOWN", "KeptClip", "check_clip_place", "kept_clip", "remove_unfinished_clips", "write_clip"]

EXACT = "exact.mkv"
"""The frames as they were drawn, every pixel of them; what is measured."""

SHOWN = "clip.mp4"
"""What a browser shows."""

_FACTS = "clip.json"
_NAMES = (EXACT, SHOWN, _FACTS)
_RECORD = ".clip_record.json"
_KIND = "clip"
_LARGEST_FACTS = 1 << 20
_UNFINISHED = re.compile(r"\.[0-9a-f]{4}")
_ABANDONED = 600.0  # seconds without a change, after which what is unfinished belongs to no process any more
_LOSSLESS = ContainerFormat(
    "matroska",
    "libx264rgb",
    "rgb24",
    options={"qp": "0", "preset": "veryfast"},
    container_options={"fflags": "+bitexact"},
)

Frame = NDArray[np.uint8]


def _present(folder: Path) -> list[str]:
    return [name for name in _NAMES if os.path.lexists(folder / name)]


_FILES = RecordedFiles(_KIND, _RECORD, "only clips that PhysAnimator wrote", _present)


@dataclass(frozen=True)
class KeptClip:
    """A clip that is there. It can be read any number of times, and counted.

    Attributes:
        folder: where it is.
        key: hash of all that it was made from.
        count: its frames.
        rate: frames a second.
        width, height: of its frames [px].
    """

    folder: Path
    key: str
    count: int
    rate: float
    width: int
    height: int

    def __len__(self) -> int:
        return self.count

    def __iter__(self) -> Iterator[Frame]:
        return iter(read_clip(self.folder / EXACT))

    @property
    def shown(self) -> Path:
        """The file that a browser shows."""
        return self.folder / SHOWN


def check_clip_place(folder: Path, *, coming: Iterable[Path] = ()) -> None:
    """Refuse a folder that holds what somebody else wrote, or changed.

    Raises:
        InvalidInputError: see :func:`~physanimator.rendering.files.check_recorded_folder`.
    """
    if folder.is_dir():
        check_recorded_folder(folder, _FILES, coming=tuple(coming))


def kept_clip(folder: Path, key: str | None = None) -> KeptClip | None:
    """The clip in a folder, whole and unchanged; None where there is none, or one that was made from something else.

    Args:
        folder: of the clip.
        key: hash of what it must have been made from; None for anything.
    """
    record = read_record(folder / _RECORD, _KIND)
    known = {each.name: each for each in record or ()}
    if set(known) != set(_NAMES) or not all(known[name].describes(folder, name) for name in _NAMES):
        return None
    try:
        with (folder / _FACTS).open("rb") as opened:
            told = json.loads(opened.read(_LARGEST_FACTS))
        size = (int(told[name]) for name in ("width", "height"))
        found = KeptClip(folder, str(told["key"]), int(told["frames"]), float(told["rate"]), *size)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    return found if key in (None, found.key) else None


def write_clip(folder: Path, frames: Iterable[Frame], rate: float, key: str, made_from: Mapping[str, Any]) -> None:
    """Write a clip; it appears, and an earlier one of ours goes, when it is complete.

    Args:
        folder: of the clip; those around it exist.
        frames: RGB, uint8, of one size, shape [h, w, 3].
        rate: frames a second.
        key: hash of what it is made from.
        made_from: the same in words, for people.

    Raises:
        InvalidInputError: there is no frame, or the folder holds what somebody else wrote.
    """

    def write(staging: Path) -> Iterable[str]:
        drawn = iter(frames)
        first = next(drawn, None)
        if first is None:
            raise InvalidInputError("a clip must have at least one frame. Got: none")
        encode(chain([first], drawn), staging / EXACT, _LOSSLESS, first.shape, exact_frame_rate(rate), exact=True)
        count = 0

        def counted() -> Iterator[Frame]:
            nonlocal count
            for frame in read_clip(staging / EXACT):
                count += 1
                yield frame

        write_animation(counted(), staging / SHOWN, rate)
        height, width = first.shape[:2]
        told = {"key": key, "frames": count, "rate": rate, "width": width, "height": height}
        write_text(staging / _FACTS, json.dumps({**told, "made_from": made_from}, indent=1) + "\n")
        return _NAMES

    write_recorded_folder(folder, _FILES, write)


def remove_unfinished_clips(clips: Path) -> int:
    """Remove what a process that was killed has left of clips.

    Args:
        clips: folder of all clips, with a folder for each method and in it one for each picture.

    Returns:
        How many were removed.
    """
    count = 0
    for place in clips.glob("*/*/.*"):
        if _UNFINISHED.match(place.name) and place.is_dir() and not place.is_symlink() and _abandoned(place):
            shutil.rmtree(place, ignore_errors=True)
            count += 1
    return count


def _abandoned(place: Path) -> bool:
    """Whether a folder holds nothing but what is ours under work, and has not changed for a while."""
    inside = list(place.rglob("*"))
    ours = all(each.name in (*_NAMES, _RECORD, "earlier") or _UNFINISHED.match(each.name) for each in inside)
    newest = max((each.stat().st_mtime for each in [place, *inside]), default=0.0)
    return ours and time.time() - newest > _ABANDONED
