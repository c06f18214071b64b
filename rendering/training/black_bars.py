"""Black bars around a film's picture, which no clip shall teach."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

__all__ = ["Box", "picture_box"]

Box = tuple[float, float, float, float]
"""Left, top, right and bottom, as shares of width and height from 0 to 1."""

_BLACK = 28  # brightest level of a bar: black of video is 16, and compression rings beside the picture
_ALIKE = 0.03  # of a side, by which two bars may differ: what is dark on one side alone is part of the picture
_MOST = 0.4  # of a side, that a bar may take


def picture_box(frames: Sequence[NDArray[np.uint8]]) -> Box:
    """Where the picture is between its bars, which must be black in every frame and alike on both sides.

    Args:
        frames: RGB, uint8, of one size, shape [h, w, 3] each.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.training.black_bars import picture_box
        >>> frame = np.zeros((90, 160, 3), np.uint8)
        >>> frame[:, 19:141] = 200
        >>> picture_box([frame])
        (0.125, 0.0, 0.875, 1.0)
    """
    if not frames:
        return (0.0, 0.0, 1.0, 1.0)
    brightest = np.max([frame.max(axis=2) for frame in frames], axis=0)
    left, right = _between(brightest.max(axis=0))
    top, bottom = _between(brightest.max(axis=1))
    return (left, top, right, bottom)


def _between(brightest: NDArray[np.uint8]) -> tuple[float, float]:
    bright = np.flatnonzero(brightest > _BLACK)
    if not len(bright):
        return 0.0, 1.0
    length = len(brightest)
    before, after = int(bright[0]), length - 1 - int(bright[-1])
    if not before or not after or abs(before - after) > 1 + _ALIKE * length or max(before, after) > _MOST * length:
        return 0.0, 1.0
    # One more than is black: in a small copy, the row beside the bar is bar in part, and would be drawn as a line.
    return (before + 1) / length, 1 - (after + 1) / length
