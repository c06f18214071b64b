"""The size that the networks work at: any illustration is scaled into a frame whose sides are multiples of 64."""

from __future__ import annotations

from dataclasses import dataclass
from math import log

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require

__all__ = ["LARGEST_AREA", "SMALLEST_AREA", "TRAINED_HEIGHT", "TRAINED_WIDTH", "Frame"]

TRAINED_WIDTH, TRAINED_HEIGHT = 576, 320
"""What LVCD was trained with [px]."""

_SIDE = 64

SMALLEST_AREA, LARGEST_AREA = _SIDE * _SIDE, 8192 * 8192
"""Between these the networks have something to see, and finding a size for them ends [px^2]."""

FloatImage = NDArray[np.float32]


@dataclass(frozen=True)
class Frame:
    """An illustration's place in a frame; the frame's margins repeat the illustration's edge.

    Attributes:
        width: of the illustration [px].
        height: of the illustration [px].
        scaled: width and height of the illustration inside the frame [px].
        size: width and height of the frame [px], multiples of 64.
    """

    width: int
    height: int
    scaled: tuple[int, int]
    size: tuple[int, int]

    @classmethod
    def around(cls, width: int, height: int, *, area: int = TRAINED_WIDTH * TRAINED_HEIGHT) -> Frame:
        """The frame that fits an illustration's proportions best.

        Args:
            width: of the illustration [px].
            height: of the illustration [px].
            area: that the frame should have [px^2].
        """
        require("area", area, area >= _SIDE * _SIDE, f"{_SIDE * _SIDE} px^2 or more")
        longest = int((area * max(width / height, height / width)) ** 0.5) // _SIDE + 1
        sides = range(_SIDE, _SIDE * (longest + 1), _SIDE)

        def misfit(size: tuple[int, int]) -> float:
            proportion = abs(log(size[0] / size[1] * height / width))
            return 2 * proportion + abs(log(size[0] * size[1] / area))

        size = min(((w, h) for w in sides for h in sides), key=misfit)
        scale = min(size[0] / width, size[1] / height)
        scaled = (min(size[0], round(scale * width)), min(size[1], round(scale * height)))
        return cls(width, height, (max(scaled[0], 1), max(scaled[1], 1)), size)

    @property
    def _margins(self) -> tuple[int, int]:
        """Columns left and rows above the illustration [px]."""
        return (self.size[0] - self.scaled[0]) // 2, (self.size[1] - self.scaled[1]) // 2

    def inward(self, picture: FloatImage) -> FloatImage:
        """A picture of the illustration's size, put into the frame.

        Args:
            picture: float32, shape [height, width, c] or [height, width].
        """
        left, top = self._margins
        right, bottom = self.size[0] - self.scaled[0] - left, self.size[1] - self.scaled[1] - top
        shrinks = self.scaled[0] < self.width
        scaled = cv2.resize(picture, self.scaled, interpolation=cv2.INTER_AREA if shrinks else cv2.INTER_CUBIC)
        framed = cv2.copyMakeBorder(scaled, top, bottom, left, right, cv2.BORDER_REPLICATE)
        return np.clip(framed, 0, 1).astype(np.float32, copy=False)

    def cells_touched(self, mask: NDArray[np.bool_], *, cell: int) -> NDArray[np.bool_]:
        """Which cells of the frame any part of a mask lies in, however small it becomes there.

        Args:
            mask: in the illustration, shape [height, width].
            cell: side of the square cells [px of the frame], of which the frame's sides are multiples.

        Returns:
            Shape [frame's height / cell, frame's width / cell]; margins are as the illustration's edge beside them.
        """
        (left, top), (columns, rows) = self._margins, self.size
        across = _touched(mask.T, self.scaled[0], left, columns, cell)
        return _touched(across.T, self.scaled[1], top, rows, cell)

    def outward(self, picture: FloatImage) -> FloatImage:
        """What lies in the frame where the illustration is, in the illustration's size, shape [height, width, c]."""
        left, top = self._margins
        inside = np.ascontiguousarray(picture[top : top + self.scaled[1], left : left + self.scaled[0]])
        shrinks = self.scaled[0] > self.width
        size = (self.width, self.height)
        scaled = cv2.resize(inside, size, interpolation=cv2.INTER_AREA if shrinks else cv2.INTER_CUBIC)
        return np.clip(scaled, 0, 1).astype(np.float32, copy=False)


def _touched(mask: NDArray[np.bool_], scaled: int, margin: int, length: int, cell: int) -> NDArray[np.bool_]:
    """Rows of cells that touch a mask, along its first axis.

    Row p of it covers scaled / rows * [p, p + 1) + margin in the frame: computed in whole numbers, so exactly.

    Args:
        mask: shape [rows, n].
        scaled: length of all its rows in the frame [px].
        margin: before them [px].
        length: of the frame [px].
        cell: length of a cell [px].

    Returns:
        Shape [length / cell, n].
    """
    rows = len(mask)
    found = []
    for start in range(0, length, cell):
        first = (start - margin) * rows // scaled
        end = -(-(start + cell - margin) * rows // scaled)
        first, end = min(max(first, 0), rows - 1), max(min(end, rows), 1)
        found.append(mask[first:end].any(axis=0))
    return np.stack(found)
