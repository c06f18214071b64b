"""Frames of a clip that is already written: a video, an animated picture or a folder of pictures."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.limits import MAX_PICTURE_PIXELS
from ..files import check_regular
from .frame_conversion import rgb_of

__all__ = ["MAX_CLIP_FRAMES", "read_clip"]

MAX_CLIP_FRAMES = 100_000
"""Frames of a clip that are read, an hour at 24 a second; they come one at a time, but a damaged file may never end."""

_PICTURES = (".png", ".jpg", ".jpeg", ".webp")
_ANIMATED = (".gif", ".webp", ".apng", ".png")


def read_clip(path: str | os.PathLike[str]) -> Iterator[NDArray[np.uint8]]:
    """Frames in turn, one at a time.

    Args:
        path: a video, an animated picture, or a folder whose pictures are taken in the order of their names.

    Returns:
        RGB, uint8, shape [h, w, 3], all of one size.

    Raises:
        InvalidInputError: there is no such clip, it is damaged or holds no frame, its frames differ in size, or it is
            larger than pictures or ``MAX_CLIP_FRAMES`` may be. What is found only on the way raises on the way.
    """
    place = Path(path)
    if os.path.isdir(place):
        return _alike(_pictures(place), place)
    check_regular(place, "clip")
    if not os.path.isfile(place):
        raise InvalidInputError(f"clip must be a video or a folder of pictures. Got: {path}")
    return _alike(_animated(place) if place.suffix.lower() in _ANIMATED else _decoded(place), place)


def _alike(frames: Iterator[NDArray[np.uint8]], path: Path) -> Iterator[NDArray[np.uint8]]:
    """The frames, as long as they are of the first one's size and not too many."""
    shape = None
    for number, frame in enumerate(frames):
        shape = shape or frame.shape
        if frame.shape != shape:
            size, first = (f"{each[1]} x {each[0]} px" for each in (frame.shape, shape))
            raise InvalidInputError(f"clip {path} must keep the size of its first frame, {first}. Got: {size}")
        if number >= MAX_CLIP_FRAMES:
            raise InvalidInputError(f"clip {path} must have at most {MAX_CLIP_FRAMES} frames. Got: more")
        yield frame
    if shape is None:
        raise InvalidInputError(f"clip {path} must have at least one frame. Got: none")


def _pictures(folder: Path) -> Iterator[NDArray[np.uint8]]:
    from .images import load_image

    names = sorted(each for each in folder.iterdir() if each.suffix.lower() in _PICTURES)
    if not names:
        raise InvalidInputError(f"clip must be a folder that holds pictures. Got: none in {folder}")
    return (load_image(name) for name in names)


def _animated(path: Path) -> Iterator[NDArray[np.uint8]]:
    from PIL import ImageSequence

    from .picture_files import check_size, reading

    with reading(path, "clip") as picture:
        for frame in ImageSequence.Iterator(picture):
            check_size(path, frame.size, "clip")
            yield np.array(frame.convert("RGB"))


def _decoded(path: Path) -> Iterator[NDArray[np.uint8]]:
    import av

    from .picture_files import check_size

    try:
        # A playlist may name other places; only files are read. A colon in a relative name would be read as a protocol.
        with av.open(str(path.absolute()), options={"protocol_whitelist": "file"}) as container:
            if not container.streams.video:
                raise InvalidInputError(f"clip {path} must have a picture track. Got: none")
            stream = container.streams.video[0]
            check_size(path, (stream.codec_context.width, stream.codec_context.height), "clip")
            stream.codec_context.options = {"max_pixels": str(MAX_PICTURE_PIXELS)}  # whatever its header says
            for frame in container.decode(stream):
                check_size(path, (frame.width, frame.height), "clip")
                yield rgb_of(frame)
    except InvalidInputError:
        raise
    except Exception as error:  # a damaged file makes FFmpeg's readers raise nearly anything
        reason = getattr(error, "strerror", None) or error
        raise InvalidInputError(f"clip {path} cannot be read: {reason or 'it is damaged'}") from error
