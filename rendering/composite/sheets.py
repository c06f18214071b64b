"""What each pixel of a moved mesh shows: a place of the drawing, and where the mesh is double, one beneath it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import Fragments, PixelBox, affine_per_triangle, rasterise
from .places import NOWHERE

__all__ = ["Places", "Sheets", "pairs_of", "sheets_at", "sheets_in_tiles"]

FloatArray = NDArray[np.float64]
Places = NDArray[np.complex64]
IndexArray = NDArray[np.int64]

# Two places that a pixel shows at once are of different sheets if they are farther apart than this [px].
_APART = 2.0
# Triangles are looked for around squares so large before they are for each tile [px].
_BLOCK = 32
_OFF = np.complex64(complex(NOWHERE, NOWHERE))


@dataclass(frozen=True, eq=False)
class Sheets:
    """Places of a drawing, as complex numbers: column + row i.

    Attributes:
        shown: place that each pixel shows, far off the drawing where the mesh is not, shape [h, w].
        double: flat numbers of pixels with another sheet beneath, shape [n].
        beneath: place that each of these shows there, shape [n].
    """

    shown: Places
    double: IndexArray
    beneath: Places

    @cached_property
    def covered(self) -> NDArray[np.bool_]:
        """Which pixels the mesh covers, shape [h, w]."""
        return np.asarray(self.shown.real > NOWHERE / 2)


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
    shifts = fragments.spread(affine_per_triangle(positions, triangles, as_places(rest - positions)))
    x = np.arange(box.left, box.right, dtype=np.float32) - canvas.left
    y = np.arange(box.top, box.bottom, dtype=np.float32) - canvas.top
    return _sheets(fragments, shifts, x, y[:, None])


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
    moves = as_places(rest - positions)[triangles[triangle]].ravel()
    shifts = fragments.spread(affine_per_triangle(points.reshape(-1, 2), pairs, moves))
    within = ((np.arange(fine) + 0.5) / scale - 0.5).astype(np.float32)
    x, y = (
        within + (tiles[:, k, None] - start).astype(np.float32) for k, start in enumerate((canvas.left, canvas.top))
    )
    return _sheets(fragments, shifts, np.repeat(x, fine, axis=0), y.reshape(-1, 1))


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


def as_places(points: NDArray[np.floating]) -> NDArray[np.complex128]:
    """Points, shape [n, 2], as complex numbers x + y i, shape [n]."""
    return np.ascontiguousarray(points, dtype=np.float64).view(np.complex128)[:, 0]


def pairs_of(places: Places) -> NDArray[np.float32]:
    """Places, shape [h, w], as OpenCV takes them: columns and rows, shape [h, w, 2]."""
    return np.ascontiguousarray(places).view(np.float32).reshape(*places.shape, 2)


def _sheets(fragments: Fragments, shifts: Places, x: NDArray[np.float32], y: NDArray[np.float32]) -> Sheets:
    """The last fragment of each pixel, and the last one before that comes from elsewhere.

    Args:
        fragments: of triangles, n pixels.
        shifts: from each of them to the place that it shows, shape [n].
        x: column of each pixel in the drawing as it is at rest, shape [h, w] or [w].
        y: row, shape [h, 1].
    """
    pixels = fragments.pixels()
    flat = np.full(len(y) * x.shape[-1], _OFF, dtype=np.complex64)
    flat[pixels] = shifts
    hidden = _hidden(flat, pixels, shifts)
    double, last = np.unique(pixels[hidden], return_index=True)
    shown = flat.reshape(len(y), -1)
    at_rest = x.astype(np.complex64)
    shown += at_rest
    shown.imag += y
    row, column = np.divmod(double, shown.shape[1])
    beneath = shifts[hidden[last]] + np.broadcast_to(at_rest, shown.shape)[row, column]
    beneath.imag += y[row, 0]
    return Sheets(shown, double, beneath)


def _hidden(flat: Places, pixels: IndexArray, shifts: Places) -> IndexArray:
    """Numbers of fragments that are hidden by one from elsewhere, the last one first, shape [k].

    Args:
        flat: shift that each pixel shows.
        pixels: of the fragments, shape [n].
        shifts: of the fragments, shape [n].
    """
    if np.count_nonzero(flat.view(np.int64) != _OFF.view(np.int64)) == len(pixels):
        return np.zeros(0, dtype=np.int64)  # no pixel has two
    hidden = np.flatnonzero(flat.take(pixels).view(np.int64) != shifts.view(np.int64))
    apart = (flat[pixels[hidden]] - shifts[hidden]).view(np.float32).reshape(-1, 2)
    return hidden[(np.abs(apart) > _APART).any(axis=1)][::-1]
