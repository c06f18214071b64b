"""Clips of any other system: a video, or a folder of frames, for each picture and sample."""

from __future__ import annotations

import os
from pathlib import Path

from ...physics.errors import InvalidInputError
from ..pictures import read_clip
from ..pictures.frame_rates import FRAME_RATES
from .evaluation_set import EvaluationSet, PictureOfSet
from .methods import Method

__all__ = ["check_foreign_clips", "clip_names", "foreign_clip", "foreign_rate"]

_ENDINGS = (".mp4", ".webm", ".mkv", ".mov", ".avi", ".gif", ".webp", ".apng")


def clip_names(picture: str, sample: int) -> tuple[str, ...]:
    """How a clip may be called, without its ending: ``hair_0``, or ``hair`` for the first sample."""
    return (f"{picture}_{sample}", picture) if sample == 0 else (f"{picture}_{sample}",)


def foreign_clip(method: Method, picture: PictureOfSet, sample: int) -> Path:
    """The file or folder that holds a sample.

    Raises:
        InvalidInputError: there is none, or more than one.
    """
    folder = Path(method.clips)
    for name in clip_names(picture.name, sample):
        there = [each for ending in _ENDINGS if (each := folder / f"{name}{ending}").is_file()]
        there += [folder / name] * (folder / name).is_dir()
        if len(there) > 1:
            raise InvalidInputError(
                f"method {method.name!r} must have one clip for each sample. Got: {there[0].name} and {there[1].name}"
            )
        if there:
            return there[0]
    wanted = " or ".join(clip_names(picture.name, sample))
    raise InvalidInputError(
        f"clips {folder} must hold {wanted}, a folder of frames or a file in {', '.join(_ENDINGS)}. Got: neither"
    )


def check_foreign_clips(which: EvaluationSet, method: Method) -> None:
    """Refuse clips that are missing or cannot be opened, before any work.

    Raises:
        InvalidInputError: the message names the clip.
    """
    if not os.path.isdir(method.clips):
        raise InvalidInputError(f"clips of method {method.name!r} must be a folder. Got: no {method.clips}")
    seen: dict[Path, str] = {}
    for picture in which.pictures:
        for sample in range(which.samples):
            place, name = foreign_clip(method, picture, sample), f"{picture.name}, sample {sample}"
            if place in seen:
                raise InvalidInputError(
                    f"clips {method.clips} must hold one for each sample. Got: {place.name} for {seen[place]} and for"
                    f" {name}"
                )
            seen[place] = name
            next(read_clip(place))


def foreign_rate(which: EvaluationSet, method: Method, place: Path) -> float:
    """Frames a second of a clip: as said of the method, as its file says, or as the set has it.

    Args:
        which: the set.
        method: of the clip.
        place: the clip.
    """
    if method.rate:
        return method.rate
    import av

    found = None
    if place.is_file():
        try:
            with av.open(str(place.absolute()), options={"protocol_whitelist": "file"}) as container:
                found = container.streams.video[0].average_rate
        except (av.FFmpegError, IndexError, OSError):  # such as animated WebP, which FFmpeg does not read
            found = None
    slowest, fastest = FRAME_RATES
    return float(found) if found and slowest <= found <= fastest else which.rate
