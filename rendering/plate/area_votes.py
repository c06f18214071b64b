"""Which area reaches how far into a hole: what is known along its rim votes, the more the nearer it is.

Near is what lies along the way of the borders: a border goes on in its direction.
"""

from __future__ import annotations

from collections.abc import Iterator

import cv2
import numpy as np
from numpy.typing import NDArray

from .border_directions import Directions

__all__ = ["area_votes"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float32]
IntArray = NDArray[np.int64]
IntImage = NDArray[np.int32]
Mask = NDArray[np.bool_]

# Votes count by the fourth power of nearness. Across the borders' way what is aside counts as this many times farther.
_ASIDE = 6.5
# No vote comes from nearer than this [px].
_NEAREST = 0.5
# Deep in the hole every so many pixels are asked, and as many of the rim have one vote; near the rim, up to this depth,
# every other one, by all of the rim within this distance [px].
_COARSE, _FINE = 4, 2
_SHALLOW = 10.0
_WITHIN = 64
_TILE = 48
_AT_ONCE = 1024
_LEAST = 1e-12


def area_votes(labels: IntImage, hole: Mask, rim: Mask, directions: Directions) -> tuple[IntArray, FloatArray]:
    """Ask the rim of a hole.

    Args:
        labels: which area each pixel belongs to, shape [h, w].
        hole: where that is not known, shape [h, w].
        rim: what votes, shape [h, w].
        directions: of the borders around.

    Returns:
        The areas that have votes, shape [k], and for each the logarithm of its votes, shape [k, h, w]; what it says
        outside of the hole means nothing.
    """
    row, column = np.nonzero(rim)
    areas, voters = np.unique(labels[row, column].astype(np.int64), return_inverse=True)
    one = np.eye(len(areas), dtype=np.float32)[voters]
    x, y = column.astype(np.float32), row.astype(np.float32)
    depth = cv2.distanceTransform(hole.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    height, width = (-(-length // _COARSE) for length in labels.shape)
    coarse = np.zeros((height, width, len(areas)), dtype=np.float32)
    grouped = _grouped(x, y, one)
    for part in _parts(_asked(hole, _COARSE)):
        coarse[part] = _votes(part, _COARSE, directions, *grouped)
    fine = _enlarged(coarse, _COARSE // _FINE)
    shallow = _asked(hole & (depth <= _SHALLOW), _FINE)
    for tile in _tiles(shallow):
        left, right, top, bottom = (
            edge(at) * _FINE + way * _WITHIN for at in tile[::-1] for edge, way in ((np.min, -1), (np.max, 1))
        )
        near = (x >= left) & (x <= right) & (y >= top) & (y <= bottom)
        fine[tile] = _votes(tile, _FINE, directions, x[near], y[near], one[near])
    votes = _enlarged(fine, _FINE)[: labels.shape[0], : labels.shape[1]]
    return areas, np.moveaxis(votes, 2, 0)


def _asked(where: Mask, step: int) -> Mask:
    """Which squares of a side have something in a mask, or beside it, shape [h / step, w / step]."""
    height, width = (-(-length // _COARSE) * _COARSE // step for length in where.shape)
    padded = np.zeros((height * step, width * step), dtype=bool)
    padded[: where.shape[0], : where.shape[1]] = where
    some = padded.reshape(height, step, width, step).any(axis=(1, 3))
    return cv2.dilate(some.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0


def _parts(asked: Mask) -> Iterator[tuple[IntArray, IntArray]]:
    row, column = np.nonzero(asked)
    for start in range(0, len(row), _AT_ONCE):
        yield row[start : start + _AT_ONCE], column[start : start + _AT_ONCE]


def _tiles(asked: Mask) -> Iterator[tuple[IntArray, IntArray]]:
    side = _TILE // _FINE
    for top in range(0, asked.shape[0], side):
        for left in range(0, asked.shape[1], side):
            row, column = np.nonzero(asked[top : top + side, left : left + side])
            if len(row):
                yield row + top, column + left


def _grouped(x: FloatArray, y: FloatArray, one: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Voters of a square, one for all: their mean place, and how many are for each area."""
    square = (y // _COARSE).astype(np.int64) * int(x.max() // _COARSE + 1) + (x // _COARSE).astype(np.int64)
    _, number, count = np.unique(square, return_inverse=True, return_counts=True)
    order = np.argsort(number, kind="stable")
    sums = np.add.reduceat(np.column_stack([x, y, one])[order], np.cumsum(count) - count, axis=0)
    x, y = ((sums[:, k] / count).astype(np.float32) for k in (0, 1))
    return x, y, sums[:, 2:]


def _votes(
    at: tuple[IntArray, IntArray], step: int, directions: Directions, x: FloatArray, y: FloatArray, one: FloatArray
) -> FloatArray:
    """Logarithms of the votes for the pixels in the middle of squares, shape [n, k]."""
    down, right = ((each * step + np.float32(step / 2 - 0.5)).astype(np.float32) for each in at)
    xx, xy, yy = directions.at(right, down).T
    # What is aside counts by how much more the borders run one way than across it.
    spread = np.sqrt(np.square(xx - yy) + 4 * xy * xy)
    # The tensor less its smaller eigenvalue is the normal's, times the spread.
    smaller = (1 - spread) / 2 * (xx + yy > 0)
    more = np.float32(_ASIDE**2 - 1) * spread
    xx, xy, yy = 1 + more * (xx - smaller), more * xy, 1 + more * (yy - smaller)
    # The squared distance as a sum of products, about the middle of the places asked.
    middle = right.mean(), down.mean()
    right, down, x, y = right - middle[0], down - middle[1], x - middle[0], y - middle[1]
    own = [
        xx, 2 * xy, yy, -2 * (xx * right + xy * down), -2 * (xy * right + yy * down),
        xx * right * right + 2 * xy * right * down + yy * down * down,
    ]  # fmt: skip
    far = np.stack(own, axis=1) @ np.stack([x * x, x * y, y * y, x, y, np.ones_like(x)]).astype(np.float32)
    np.maximum(far, 0, out=far)
    far += np.float32(_NEAREST**2)
    np.multiply(far, far, out=far)
    np.reciprocal(far, out=far)
    return np.asarray(np.log(np.maximum(far @ one.astype(np.float32), np.float32(_LEAST))))


def _enlarged(votes: FloatArray, times: int) -> FloatArray:
    size = votes.shape[1] * times, votes.shape[0] * times
    planes = [cv2.resize(votes[..., k], size, interpolation=cv2.INTER_LINEAR) for k in range(votes.shape[2])]
    return np.stack(planes, axis=-1)
