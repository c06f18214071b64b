"""Rasteriser: which triangle covers which pixel centre, and vertex values spread over those pixels.

One pass of vectorised scan conversion. A pixel belongs to a triangle when its centre lies in the half-open spans
between the triangle's edges, and both neighbours of an edge compute its crossings from the same numbers: triangles
that share an edge leave neither a gap nor a double pixel, whatever their shape. Triangles may be inverted or
overlap; where they overlap, the later one wins.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .pixel_box import PixelBox

__all__ = [
    "Fragments",
    "affine_per_triangle",
    "barycentric",
    "interpolate",
    "rasterise",
    "triangle_ids",
]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]


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
        before = np.cumsum(self.length) - self.length
        return np.arange(self.count) + np.repeat(self.row * self.box.width + self.column - before, self.length)

    def triangles(self) -> IndexArray:
        """Triangle of every pixel, shape [n]."""
        return np.repeat(self.triangle, self.length)

    def spread(self, offset: FloatArray, gradient: FloatArray) -> NDArray[np.float32]:
        """Values of affine functions of position, one set a triangle, at every pixel centre.

        Args:
            offset: value at the picture's origin, shape [t, k].
            gradient: change per pixel in x and y, shape [t, k, 2].

        Returns:
            Values, shape [k, n].
        """
        x = self.box.left + self.column + 0.5
        y = self.box.top + self.row + 0.5
        slope = gradient[self.triangle, :, 0]
        start = offset[self.triangle] + slope * x[:, None] + gradient[self.triangle, :, 1] * y[:, None]
        step = np.arange(self.count, dtype=np.float32)
        step -= np.repeat((np.cumsum(self.length) - self.length).astype(np.float32), self.length)
        values = np.repeat(slope.T.astype(np.float32), self.length, axis=1)
        values *= step
        values += np.repeat(start.T.astype(np.float32), self.length, axis=1)
        return values


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
    corners = _sorted_by_height(np.asarray(points, dtype=np.float64), np.asarray(triangles))
    (xa, ya), (xb, yb), (xc, yc) = corners
    first = np.maximum(np.ceil(ya - 0.5), top).astype(np.int64)
    last = np.minimum(np.ceil(yc - 0.5), bottom).astype(np.int64)
    count = np.maximum(last - first, 0)
    triangle = np.repeat(np.arange(len(count)), count)
    row = np.arange(len(triangle)) + np.repeat(first - (np.cumsum(count) - count), count)
    y = row + 0.5
    with np.errstate(divide="ignore", invalid="ignore"):
        slope_ab, slope_bc, slope_ac = (xb - xa) / (yb - ya), (xc - xb) / (yc - yb), (xc - xa) / (yc - ya)
    upper = y < yb[triangle]
    short_x = np.where(upper, xa[triangle], xb[triangle])
    short_y = np.where(upper, ya[triangle], yb[triangle])
    short = short_x + (y - short_y) * np.where(upper, slope_ab[triangle], slope_bc[triangle])
    long = xa[triangle] + (y - ya[triangle]) * slope_ac[triangle]
    begin = np.maximum(np.ceil(np.minimum(short, long) - 0.5), box.left).astype(np.int64)
    end = np.minimum(np.ceil(np.maximum(short, long) - 0.5), box.right).astype(np.int64)
    kept = np.flatnonzero(end > begin)
    return Fragments(triangle[kept], row[kept] - box.top, begin[kept] - box.left, (end - begin)[kept], box)


def _sorted_by_height(points: FloatArray, triangles: NDArray[np.integer]) -> list[tuple[FloatArray, FloatArray]]:
    """Corners a, b, c of each triangle from top to bottom, as (x, y).

    An edge always runs from its upper to its lower end, so both its triangles round its crossings alike.
    """
    order = np.argsort(points[triangles, 1], axis=1)
    corners = points[np.take_along_axis(triangles, order, axis=1)]
    return [(corners[:, k, 0], corners[:, k, 1]) for k in range(3)]


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


def affine_per_triangle(points: ArrayLike, triangles: ArrayLike, values: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """The affine functions that take given values at the corners of triangles.

    Args:
        points: vertex positions [px], shape [v, 2].
        triangles: vertex indices, shape [t, 3].
        values: value of each vertex, shape [v, k].

    Returns:
        Value at the picture's origin, shape [t, k], and gradient per pixel in x and y, shape [t, k, 2]; both zero
        for triangles without an area.
    """
    indices = np.asarray(triangles)
    corners = np.asarray(points, dtype=np.float64)[indices]
    at_corners = np.asarray(values, dtype=np.float64)[indices]
    (ux, uy), (vx, vy) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    area = ux * vy - uy * vx
    inverse = np.divide(1.0, area, out=np.zeros_like(area), where=area != 0)[:, None]
    du, dv = at_corners[:, 1] - at_corners[:, 0], at_corners[:, 2] - at_corners[:, 0]
    dx = (du * vy[:, None] - dv * uy[:, None]) * inverse
    dy = (dv * ux[:, None] - du * vx[:, None]) * inverse
    offset = at_corners[:, 0] - dx * corners[:, 0, :1] - dy * corners[:, 0, 1:]
    return offset, np.stack([dx, dy], axis=-1)


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
    spread = fragments.spread(*affine_per_triangle(points, triangles, values))
    planes = np.full((len(spread), box.height * box.width), fill, dtype=np.float32)
    pixels = fragments.pixels()
    for plane, line in zip(planes, spread, strict=True):
        plane[pixels] = line
    return planes.reshape(-1, box.height, box.width)
