"""From frames of any size to the size of the data: never stretched, the middle is kept."""

from __future__ import annotations

import re

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.checks import is_whole
from ...physics.errors import InvalidInputError
from .black_bars import Box

__all__ = ["MULTIPLE", "Window", "framed", "size_of", "window_of"]

MULTIPLE = 64
"""Both video models take widths and heights that are multiples of it [px]."""

_LARGEST = 2048
_MOST_ENLARGED = 2.0

Window = tuple[int, int, int, int]
"""Left, top, right and bottom [px]."""


def size_of(text: str) -> tuple[int, int]:
    """Width and height from ``512x320``.

    Raises:
        InvalidInputError: it is none, or not in multiples of 64 px.
    """
    found = re.fullmatch(r"(\d{1,5})\s*[xX]\s*(\d{1,5})", text.strip())
    sides = (int(found[1]), int(found[2])) if found else (0, 0)
    fits = all(is_whole(side, MULTIPLE, _LARGEST) and side % MULTIPLE == 0 for side in sides)
    if not fits:
        raise InvalidInputError(
            f"size must be WIDTHxHEIGHT in multiples of {MULTIPLE} px to {_LARGEST}, such as 512x320. Got: {text:.60}"
        )
    return sides


def window_of(width: int, height: int, box: Box, size: tuple[int, int], *, pixel_aspect: float = 1.0) -> Window | None:
    """The largest window of the wanted proportions in the middle of the picture; None where it is too small.

    Args:
        width, height: of the frames [px].
        box: where the picture is between its bars.
        size: width and height that are wanted [px].
        pixel_aspect: width of a pixel over its height.

    Returns:
        The window, or None where it would have to be enlarged more than twice.
    """
    left, top, right, bottom = box[0] * width, box[1] * height, box[2] * width, box[3] * height
    wide, high = (right - left) * pixel_aspect, bottom - top
    scale = max(size[0] / wide, size[1] / high) if wide > 0 and high > 0 else np.inf
    if scale > _MOST_ENLARGED:
        return None
    half_width, half_height = size[0] / scale / pixel_aspect / 2, size[1] / scale / 2
    x, y = (left + right) / 2, (top + bottom) / 2
    first = (max(0, round(x - half_width)), max(0, round(y - half_height)))
    last = (min(width, round(x + half_width)), min(height, round(y + half_height)))
    return (*first, *last)


def framed(frame: NDArray[np.uint8], window: Window, size: tuple[int, int]) -> NDArray[np.uint8]:
    """A window of a frame at the data's size.

    Args:
        frame: RGB, uint8, shape [h, w, 3].
        window: see :func:`window_of`.
        size: width and height [px].
    """
    left, top, right, bottom = window
    part = frame[top:bottom, left:right]
    smaller = part.shape[1] > size[0]
    return np.asarray(cv2.resize(part, size, interpolation=cv2.INTER_AREA if smaller else cv2.INTER_CUBIC))
