"""Frames of a clip that is already written: a video, an animated picture or a folder of pictures."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..physics.errors import InvalidInputError

__all__ = ["read_clip"]

_PICTURES = (".png", ".jpg", ".jpeg", ".webp")
_ANIMATED = (".gif", ".webp", ".apng", ".png")


def read_clip(path: str | os.PathLike[str]) -> Iterator[NDArray[np.uint8]]:
    """Frames in turn, one at a time.

    Args:
        path: a video, an animated picture, or a folder whose pictures are taken in the order of their names.

    Returns:
        RGB, uint8, shape [h, w, 3].

    Raises:
        InvalidInputError: there is no such clip, or it cannot be read.
    """
    place = Path(path)
    if place.is_dir():
        return _pictures(place)
    if not place.is_file():
        raise InvalidInputError(f"clip must be a video or a folder of pictures. Got: {path}")
    return _animated(place) if place.suffix.lower() in _ANIMATED else _decoded(place)


def _pictures(folder: Path) -> Iterator[NDArray[np.uint8]]:
    from .images import load_image

    names = sorted(each for each in folder.iterdir() if each.suffix.lower() in _PICTURES)
    if not names:
        raise InvalidInputError(f"clip must be a folder that holds pictures. Got: none in {folder}")
    return (load_image(name) for name in names)


def _animated(path: Path) -> Iterator[NDArray[np.uint8]]:
    from PIL import Image, ImageSequence, UnidentifiedImageError

    try:
        with Image.open(path) as picture:
            for frame in ImageSequence.Iterator(picture):
                yield np.array(frame.convert("RGB"))
    except (UnidentifiedImageError, OSError, SyntaxError, ValueError) as error:
        raise InvalidInputError(f"clip {path} cannot be read: {error}") from error


def _decoded(path: Path) -> Iterator[NDArray[np.uint8]]:
    import av

    try:
        with av.open(str(path.absolute())) as container:  # a colon in a relative name would be read as a protocol
            for frame in container.decode(video=0):
                yield _rgb(frame)
    except (av.FFmpegError, IndexError) as error:
        raise InvalidInputError(f"clip {path} cannot be read: {error}") from error


def _rgb(frame: Any) -> NDArray[np.uint8]:
    return np.ascontiguousarray(frame.to_ndarray(format="rgb24"))
