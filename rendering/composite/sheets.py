"""What each pixel of a moved mesh shows: a place of the drawing, and where the mesh is double, one beneath it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import Fragments, PixelBox, affine_per_triangle, rasterise
from .places import NOWHERE

__all__ = ["Sheets", "sheets_at", "sheets_in_tiles"]

FloatArray = NDArray[np.float64]
FloatImage = NDArray[np.float32]
IndexArray = NDArray[np.int64]

# Two places that a pixel shows at once are of different sheets if they are farther apart than this [px].
_APART = 2.0
# Triangles are looked for around squares so large before they are for each tile [px].
_BLOCK = 32


@dataclass(frozen=True, eq=False)
class Sheets:
    """Places of a drawing.

    Attributes:
        x: column that each pixel shows, NOWHERE off the mesh, shape [h, w].
        y: row, of the same shape.
        double: flat numbers of pixels with another sheet beneath, shape [n].
        beneath: column and row that each of these shows there, shape [2, n].
    """

    x: FloatImage
    y: FloatImage
    double: IndexArray
    beneath: FloatImage


def sheets_at(
    positions: FloatArray, triangles: NDArray[np.integer], rest: FloatArray, box: PixelBox, canvas: PixelBox
) -> Sheets:
    """What the pixels of a box show.

    Args:
        positions: of the vertices [px], shape [v, 2].
        triangles: shape [t, 3]; later ones are over earlier ones.
        rest: positions at rest [px], shape [v, 2].
        box: the pixels that are wanted.
        canvas: in whose pixels the places are told; pixel [0, 0] has its centre at (0, 0).
    """
    fragments = rasterise(positions, triangles, box)
    shifts = fragments.spread(*affine_per_triangle(positions, triangles, rest - positions))
    x = np.arange(box.left, box.right, dtype=np.float32) - canvas.left
    y = np.arange(box.top, box.bottom, dtype=np.float32) - canvas.top
    return _sheets(fragments, shifts, *np.broadcast_arrays(x, y[:, None]))


def sheets_in_tiles(
    positions: FloatArray,
    triangles: NDArray[np.integer],
    rest: FloatArray,
    tiles: IndexArray,
    canvas: PixelBox,
    *,
    side: int,
    scale: int,
) -> Sheets:
    """What square tiles show at several places in each pixel, all tiles below one another.

    Args:
        positions: of the vertices [px], shape [v, 2].
        triangles: shape [t, 3]; later ones are over earlier ones.
        rest: positions at rest [px], shape [v, 2].
        tiles: left and top pixel of each, shape [k, 2].
        canvas: in whose pixels the places are told; pixel [0, 0] has its centre at (0, 0).
        side: of a tile [px].
        scale: how many places there are along each side of a pixel.

    Returns:
        Places, shape [k side scale, side scale].
    """
    corners = positions[triangles]
    blocks = _BLOCK * np.array(sorted(set(map(tuple, (tiles // _BLOCK).tolist()))))
    kept = _touching(corners, blocks, _BLOCK + side).any(axis=0)
    triangles, corners = triangles[kept], corners[kept]
    tile, triangle = np.nonzero(_touching(corners, tiles, side))
    fine = side * scale
    top = tile * fine
    points = (corners[triangle] - tiles[tile][:, None]) * scale
    points[..., 1] += top[:, None]
    box = PixelBox(0, 0, fine, len(tiles) * fine)
    pairs = np.arange(3 * len(tile)).reshape(-1, 3)
    fragments = rasterise(points.reshape(-1, 2), pairs, box, rows=(top, top + fine))
    moves = (rest - positions)[triangles[triangle]].reshape(-1, 2)
    shifts = fragments.spread(*affine_per_triangle(points.reshape(-1, 2), pairs, moves))
    within = ((np.arange(fine) + 0.5) / scale - 0.5).astype(np.float32)
    x, y = (
        within + (tiles[:, k, None] - start).astype(np.float32) for k, start in enumerate((canvas.left, canvas.top))
    )
    return _sheets(fragments, shifts, *np.broadcast_arrays(np.repeat(x, fine, axis=0), y.reshape(-1, 1)))


def _touching(corners: FloatArray, starts: IndexArray, side: int) -> NDArray[np.bool_]:
    """Whether the box of each triangle reaches into each square, shape [k, t].

    Args:
        corners: of the triangles [px], shape [t, 3, 2].
        starts: left and top of the squares [px], shape [k, 2].
        side: of the squares [px].
    """
    near = np.ones((len(starts), len(corners)), dtype=bool)
    for (a, b, c), start in zip(corners.T, starts.T[:, :, None], strict=True):
        near &= np.maximum(np.maximum(a, b), c) > start
        near &= np.minimum(np.minimum(a, b), c) < start + side
    return near


def _sheets(fragments: Fragments, shifts: FloatImage, x: FloatImage, y: FloatImage) -> Sheets:
    """The last fragment of each pixel, and the last one before that comes from elsewhere.

    Args:
        fragments: of triangles, n pixels.
        shifts: from each of them to the place that it shows, shape [2, n].
        x: column of each pixel in the drawing as it is at rest, shape [h, w].
        y: row, of the same shape.
    """
    pixels = fragments.pixels()
    planes = np.full((2, x.size), NOWHERE, dtype=np.float32)
    for plane, shift in zip(planes, shifts, strict=True):
        plane[pixels] = shift
    hidden = np.flatnonzero(_apart(planes[0].take(pixels), shifts[0]) | _apart(planes[1].take(pixels), shifts[1]))[::-1]
    double, last = np.unique(pixels[hidden], return_index=True)
    beneath = shifts[:, hidden[last]] + np.stack([x.ravel()[double], y.ravel()[double]])
    planes = planes.reshape(2, *x.shape)
    planes[0] += x
    planes[1] += y
    return Sheets(planes[0], planes[1], double, beneath)


def _apart(one: FloatImage, other: FloatImage) -> NDArray[np.bool_]:
    """Whether values are of different sheets; the first ones are lost."""
    one -= other
    return np.asarray(np.abs(one, out=one) > _APART)
