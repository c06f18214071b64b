"""Edges of the sheets of a moved mesh: where it parts along a slit, and where it lies over itself.

The edge of a part is soft by its own alpha. A slit goes through what is opaque, and what lies over another sheet ends
there: with one place a pixel, both would be stepped.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, half_edges, on_boundary
from .boundary import same_places
from .sheets import Sheets

__all__ = ["Slits", "drawn_sides", "tiles_of", "torn"]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]
Mask = NDArray[np.bool_]

# Neighbouring pixels that come from places farther apart than this are of different sheets [px].
_APART = 4.0
_SHIFT = 4  # bits behind the point of places that OpenCV draws lines between


@dataclass(frozen=True, eq=False)
class Slits:
    """The sides of the slits in a mesh, whose places are the same at rest.

    Attributes:
        sides: vertices at the ends of each side, shape [s, 2].
        twins: for each vertex the first one at the same place, shape [v].
    """

    sides: IndexArray
    twins: IndexArray

    @classmethod
    def of(cls, rest: FloatArray, triangles: NDArray[np.integer]) -> Slits:
        """Slits of a mesh: edges of one triangle alone, at whose place there is another one.

        Args:
            rest: positions at rest [px], shape [v, 2].
            triangles: shape [t, 3].
        """
        twins = same_places(rest)
        sides = half_edges(triangles)
        cut = on_boundary(sides) & ~on_boundary(twins[sides])
        return cls(sides[cut].astype(np.int64), twins)

    def opened(self, shifts: FloatArray) -> IndexArray:
        """Sides that have left their other side: vertices at their ends, shape [s, 2].

        Args:
            shifts: how far each vertex has moved [px], shape [v, 2].
        """
        if not len(self.sides):
            return self.sides
        apart = (shifts != shifts[self.twins]).any(axis=1)
        left = np.zeros(len(apart), bool)
        left[self.twins[apart]] = True
        return self.sides[left[self.twins[self.sides]].any(axis=1)]


def drawn_sides(sides: IndexArray, positions: FloatArray, box: PixelBox) -> Mask:
    """Pixels of a box through which sides of slits go, shape [box height, box width].

    Args:
        sides: vertices at their ends, shape [s, 2].
        positions: of the vertices [px], shape [v, 2].
        box: pixels of the picture.
    """
    near = np.zeros((box.height, box.width), np.uint8)
    lines = (positions[sides] - (box.left + 0.5, box.top + 0.5)) * 2**_SHIFT
    cv2.polylines(near, list(np.rint(lines).astype(np.int32)), False, 1, 3, cv2.LINE_8, _SHIFT)
    return near.view(bool)


def torn(sheets: Sheets) -> Mask:
    """Pixels beside others that come from far apart, shape [h, w]: the ends of what lies over another sheet."""
    found = np.zeros(sheets.shown.shape, dtype=bool)
    if not len(sheets.double):
        return found
    places = np.divmod(sheets.double, sheets.shown.shape[1])
    rows, columns = (slice(max(0, int(each.min()) - 1), int(each.max()) + 2) for each in places)
    shown, part, there = sheets.shown[rows, columns], found[rows, columns], sheets.covered[rows, columns]
    x, y = shown.real, shown.imag
    for before, after in (
        ((slice(None), slice(None, -1)), (slice(None), slice(1, None))),
        ((slice(None, -1), slice(None)), (slice(1, None), slice(None))),
    ):
        jump = (np.abs(x[after] - x[before]) > _APART) | (np.abs(y[after] - y[before]) > _APART)
        jump &= there[after] & there[before]
        part[after] |= jump
        part[before] |= jump
    return found


def tiles_of(found: Mask, side: int) -> IndexArray:
    """Left and top of the square tiles in which there are pixels, shape [k, 2]."""
    pixels = cv2.findNonZero(found.view(np.uint8))
    if pixels is None:
        return np.zeros((0, 2), dtype=np.int64)
    across = found.shape[1] // side + 1
    column, row = pixels.reshape(-1, 2).T // side
    tile = np.unique(row * across + column).astype(np.int64)
    return side * np.stack([tile % across, tile // across], axis=1)
