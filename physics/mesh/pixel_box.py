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
        left, right = np.clip((self.left, self.right), 0, width).tolist()
        top, bottom = np.clip((self.top, self.bottom), 0, height).tolist()
        return PixelBox(left, top, right, bottom)


def bounding_box(points: ArrayLike, *, margin: int = 0) -> PixelBox:
    """The smallest box of pixels around points.

    Args:
        points: positions [px], shape [n, 2].
        margin: pixels to add on every side.
    """
    points = np.asarray(points)
    left, top = np.floor(points.min(axis=0)).astype(int).tolist()
    right, bottom = np.ceil(points.max(axis=0)).astype(int).tolist()
    return PixelBox(left - margin, top - margin, right + margin, bottom + margin)
