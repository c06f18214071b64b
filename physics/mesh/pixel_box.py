"""Rectangles of whole pixels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["PixelBox", "bounding_box"]


@dataclass(frozen=True)
class PixelBox:
    """A rectangle of whole pixels, the end exclusive; it may reach beyond the picture.

    Attributes:
        left: first column.
        top: first row.
        right: column after the last.
        bottom: row after the last.
    """

    left: int
    top: int
    right: int
    bottom: int

    @property
    def width(self) -> int:
        """Number of columns, at least 0."""
        return max(0, self.right - self.left)

    @property
    def height(self) -> int:
        """Number of rows, at least 0."""
        return max(0, self.bottom - self.top)

    @property
    def slices(self) -> tuple[slice, slice]:
        """Rows and columns, to index a picture that holds the box."""
        return slice(self.top, self.bottom), slice(self.left, self.right)

    def clipped(self, width: int, height: int) -> PixelBox:
        """The part within a picture of this size."""
        left, right = (min(max(each, 0), width) for each in (self.left, self.right))
        top, bottom = (min(max(each, 0), height) for each in (self.top, self.bottom))
        return PixelBox(left, top, right, bottom)


def bounding_box(points: ArrayLike, *, margin: int = 0) -> PixelBox:
    """The smallest box of pixels around points.

    Args:
        points: positions [px], shape [n, 2].
        margin: pixels to add on every side.
    """
    x, y = np.ascontiguousarray(np.asarray(points).T)
    left, top = int(np.floor(x.min())), int(np.floor(y.min()))
    right, bottom = int(np.ceil(x.max())), int(np.ceil(y.max()))
    return PixelBox(left - margin, top - margin, right + margin, bottom + margin)
