"""Rasteriser: which triangle covers which pixel centre, and vertex values spread over those pixels.

One pass of vectorised scan conversion. A pixel belongs to a triangle when its centre lies in the half-open spans
between the triangle's edges, and both neighbours of an edge compute its crossings from the same numbers: triangles
that share an edge leave neither a gap nor a double pixel, whatever their shape. Triangles may be inverted or
overlap; where they overlap, the later one wins.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .pixel_box import PixelBox

__all__ = [
    "AffinePerTriangle",
    "Fragments",
    "affine_per_triangle",
    "barycentric",
    "interpolate",
    "rasterise",
    "triangle_ids",
]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]


class AffinePerTriangle(NamedTuple):
    """An affine function of position in each triangle, real or complex; constant in triangles without an area.

    Attributes:
        offset: value at the picture's origin, shape [t].
        slope: change per pixel to the right, shape [t].
        slope_down: change per pixel downwards, shape [t].
    """

    offset: NDArray[Any]
    slope: NDArray[Any]
    slope_down: NDArray[Any]


@dataclass(frozen=True, eq=False)
class Fragments:
    """The pixels that triangles cover: runs along rows, in the order of the triangles.

    Attributes:
        triangle: triangle of each run, shape [r].
        row: row of each run within the box, shape [r].
        column: first column of each run within the box, shape [r].
        length: number of pixels of each run, at least 1, shape [r].
        box: the rectangle that was rasterised.
    """

    triangle: IndexArray
    row: IndexArray
    column: IndexArray
    length: IndexArray
    box: PixelBox

    @property
    def count(self) -> int:
        """Number of pixels; one that several triangles cover counts as often."""
        return int(self.length.sum())

    def pixels(self) -> IndexArray:
        """Flat index (row * box width + column) of every pixel, shape [n]."""
        starts = self.row * self.box.width + self.column - self._before
        pixels = starts.take(self._run)
        pixels += np.arange(self.count)
        return pixels

    def triangles(self) -> IndexArray:
        """Triangle of every pixel, shape [n]."""
        return self.triangle.take(self._run)

    def spread(self, field: AffinePerTriangle) -> NDArray[Any]:
        """Values of an affine function of position in each triangle, at every pixel centre.

        Returns:
            Values, float32 or complex64, shape [n].
        """
        offset, slope, slope_down = (each.take(self.triangle) for each in field)
        start = slope * (self.box.left + self.column + 0.5)
        start += offset
        slope_down *= self.box.top + self.row + 0.5
        start += slope_down
        single = np.complex64 if np.iscomplexobj(start) else np.float32
        steps = np.arange(self.count)
        steps -= self._before.take(self._run)
        values = slope.astype(single).take(self._run)
        values *= steps.astype(single)
        values += start.astype(single).take(self._run)
        return values

    @cached_property
    def _before(self) -> IndexArray:
        """How many pixels there are before each run, shape [r]."""
        return np.cumsum(self.length) - self.length

    @cached_property
    def _run(self) -> IndexArray:
        """Run of every pixel, shape [n]."""
        run = np.zeros(self.count, dtype=np.int64)
        run[self._before[1:]] = 1
        return np.cumsum(run, out=run)


def rasterise(
    points: ArrayLike, triangles: ArrayLike, box: PixelBox, *, rows: tuple[IndexArray, IndexArray] | None = None
) -> Fragments:
    """Find the pixel centres inside each triangle.

    Args:
        points: vertex positions [px], shape [v, 2].
        triangles: vertex indices, shape [t, 3]; any winding.
        box: pixels to look at.
        rows: for each triangle the first row of these that it may touch and the one after the last, shape [t] each;
            None for those of the box.
    """
    top, bottom = (box.top, box.bottom) if rows is None else rows
    (xa, ya), (xb, yb), (xc, yc) = _sorted_by_height(np.asarray(points, dtype=np.float64), np.asarray(triangles))
    first, middle, last = (np.clip(np.ceil(y - 0.5), top, bottom).astype(np.int64) for y in (ya, yb, yc))
    with np.errstate(divide="ignore", invalid="ignore"):
        slope_ab, slope_bc, slope_ac = (xb - xa) / (yb - ya), (xc - xb) / (yc - yb), (xc - xa) / (yc - ya)
    # Above and below the middle corner: on one side the long edge, on the other a short one.
    count = _in_turn(middle - first, last - middle)
    half = np.repeat(np.arange(len(count)), count)
    row = np.arange(len(half)) + (_in_turn(first, middle) - (np.cumsum(count) - count)).take(half)
    y, triangle = row + 0.5, half >> 1
    short = _crossings(y, half, _in_turn(xa, xb), _in_turn(ya, yb), _in_turn(slope_ab, slope_bc))
    long = _crossings(y, triangle, xa, ya, slope_ac)
    begin = np.maximum(np.ceil(np.minimum(short, long) - 0.5), box.left).astype(np.int64)
    end = np.minimum(np.ceil(np.maximum(short, long) - 0.5), box.right).astype(np.int64)
    length = end - begin
    kept = np.flatnonzero(length > 0)
    return Fragments(triangle.take(kept), row.take(kept) - box.top, begin.take(kept) - box.left, length.take(kept), box)


def _in_turn(one: NDArray[Any], other: NDArray[Any]) -> NDArray[Any]:
    """One value of each array after the other, shape [2 t] of [t] each."""
    return np.stack([one, other], axis=1).ravel()


def _crossings(
    y: FloatArray, edge: IndexArray, start_x: FloatArray, start_y: FloatArray, slope: FloatArray
) -> FloatArray:
    """Where edges go through rows, shape [r]: column of the edge with each number at each height."""
    x = y - start_y.take(edge)
    x *= slope.take(edge)
    x += start_x.take(edge)
    return x


def _sorted_by_height(points: FloatArray, triangles: NDArray[np.integer]) -> list[tuple[FloatArray, FloatArray]]:
    """Corners a, b, c of each triangle from top to bottom, as (x, y).

    An edge always runs from its upper to its lower end, so both its triangles round its crossings alike.
    """
    corners = _corners(points, triangles)
    for upper, lower in ((0, 1), (1, 2), (0, 1)):
        (xa, ya), (xb, yb) = corners[upper], corners[lower]
        turned = ya > yb
        corners[upper] = np.where(turned, xb, xa), np.minimum(ya, yb)
        corners[lower] = np.where(turned, xa, xb), np.maximum(ya, yb)
    return corners


def _corners(points: FloatArray, triangles: NDArray[np.integer]) -> list[tuple[FloatArray, FloatArray]]:
    """The corners of each triangle, as (x, y)."""
    x, y = np.ascontiguousarray(points.T)
    return [(x.take(corner), y.take(corner)) for corner in np.asarray(triangles).T]


def triangle_ids(points: ArrayLike, triangles: ArrayLike, box: PixelBox) -> NDArray[np.int32]:
    """The triangle at each pixel centre, -1 where there is none.

    Args:
        points: vertex positions [px], shape [v, 2].
        triangles: vertex indices, shape [t, 3]; later triangles win.
        box: pixels to look at.

    Returns:
        Triangle numbers, shape [box height, box width].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import PixelBox, triangle_ids
        >>> triangle_ids(np.array([[0, 0], [4, 0], [0, 4]]), np.array([[0, 1, 2]]), PixelBox(0, 0, 4, 3)).tolist()
        [[0, 0, 0, -1], [0, 0, -1, -1], [0, -1, -1, -1]]
    """
    ids = np.full(box.height * box.width, -1, dtype=np.int32)
    fragments = rasterise(points, triangles, box)
    ids[fragments.pixels()] = fragments.triangles()
    return ids.reshape(box.height, box.width)


def affine_per_triangle(points: ArrayLike, triangles: ArrayLike, values: ArrayLike) -> AffinePerTriangle:
    """The affine functions that take given values at the corners of triangles.

    Args:
        points: vertex positions [px], shape [v, 2].
        triangles: vertex indices, shape [t, 3].
        values: value of each vertex, real or complex, shape [v].
    """
    indices, given = np.asarray(triangles), np.asarray(values)
    (xa, ya), (xb, yb), (xc, yc) = _corners(np.asarray(points, dtype=np.float64), indices)
    a, b, c = (given.take(corner) for corner in indices.T)
    ux, uy, vx, vy = xb - xa, yb - ya, xc - xa, yc - ya
    area = ux * vy - uy * vx
    inverse = np.divide(1.0, area, out=np.zeros_like(area), where=area != 0)
    du, dv = b - a, c - a
    dx, dy = (du * vy - dv * uy) * inverse, (dv * ux - du * vx) * inverse
    return AffinePerTriangle(a - dx * xa - dy * ya, dx, dy)


def barycentric(points: FloatArray, corners: FloatArray) -> FloatArray:
    """Barycentric coordinates of one point, inside or outside, in each of many triangles.

    Args:
        points: positions [px], shape [n, 2].
        corners: the triangles' corners [px], shape [n, 3, 2].

    Returns:
        Weights of the corners, of sum 1, shape [n, 3].
    """
    (ux, uy), (vx, vy) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    px, py = (points - corners[:, 0]).T
    area = ux * vy - uy * vx
    b, c = (px * vy - py * vx) / area, (ux * py - uy * px) / area
    return np.stack([1 - b - c, b, c], axis=1)


def interpolate(
    points: ArrayLike, triangles: ArrayLike, values: ArrayLike, box: PixelBox, *, fill: float = np.nan
) -> NDArray[np.float32]:
    """Spread vertex values over the pixels of a mesh, affine in each triangle.

    Args:
        points: vertex positions [px], shape [v, 2].
        triangles: vertex indices, shape [t, 3]; later triangles win.
        values: value of each vertex, shape [v, k].
        box: pixels to fill.
        fill: value of pixels outside the mesh.

    Returns:
        Values, shape [k, box height, box width].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import PixelBox, interpolate
        >>> corners = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]])
        >>> interpolate(corners, np.array([[0, 1, 2]]), corners[:, :1], PixelBox(0, 0, 3, 1)).tolist()
        [[[0.5, 1.5, 2.5]]]
    """
    fragments = rasterise(points, triangles, box)
    pixels = fragments.pixels()
    columns = np.asarray(values, dtype=np.float64).T
    planes = np.full((len(columns), box.height * box.width), fill, dtype=np.float32)
    for plane, column in zip(planes, columns, strict=True):
        plane[pixels] = fragments.spread(affine_per_triangle(points, triangles, column))
    return planes.reshape(-1, box.height, box.width)
