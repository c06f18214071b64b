"""Which area reaches how far into a hole: what is known along its rim votes, the more the nearer it is.

Near is what lies along the way of the borders: a border goes on in its direction. And what ends in sight hardly goes
on farther behind a part than it is large.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from .border_directions import Directions, squares_with

__all__ = ["elected_areas"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float32]
IntArray = NDArray[np.int64]
IntImage = NDArray[np.int32]
Mask = NDArray[np.bool_]

# Votes count by the fourth power of nearness, and by the sixth from farther than what they are a part of is large.
# Across the borders' way what is aside counts as this many times farther.
_ASIDE = 6.5
# No vote comes from nearer than this [px].
_NEAREST = 0.5
# Deep in the hole every so many pixels are asked, and as many of the rim have one vote; near the rim, up to this depth,
# every other one, by all of the rim within this distance [px].
_COARSE, _FINE = 4, 2
# Of larger holes no more squares are asked than about these: the farther from the rim, the less it changes.
_SQUARES = 8000
_SHALLOW = 10.0
_WITHIN = 64
_TILE = 48
_AT_ONCE = 128
_LEAST = 1e-30


@dataclass(frozen=True, eq=False)
class _Voters:
    """Places of the rim [px], for which area they are, and 1 / size^2 of what they are a part of; shape [q, ...]."""

    x: FloatArray
    y: FloatArray
    area: FloatArray
    bound: FloatArray

    def within(self, left: int, right: int, top: int, bottom: int) -> _Voters:
        near = (self.x >= left) & (self.x <= right) & (self.y >= top) & (self.y <= bottom)
        return _Voters(self.x[near], self.y[near], self.area[near], self.bound[near])

    def grouped(self, step: int) -> _Voters:
        """Those of a square as one: at their mean place, and as many for each area."""
        square = (self.y // step).astype(np.int64) * int(self.x.max() + 1) + (self.x // step).astype(np.int64)
        _, number, count = np.unique(square, return_inverse=True, return_counts=True)
        order = np.argsort(number, kind="stable")
        each = np.column_stack([self.x, self.y, self.bound, self.area])[order]
        sums = np.add.reduceat(each, np.cumsum(count) - count, axis=0)
        x, y, bound = (sums[:, :3] / count[:, None]).astype(np.float32).T
        return _Voters(x, y, sums[:, 3:], bound)


def elected_areas(labels: IntImage, hole: Mask, rim: Mask, directions: Directions) -> IntImage:
    """Ask the rim of a hole which area each of its pixels belongs to.

    Args:
        labels: which area each pixel belongs to, shape [h, w].
        hole: where that is not known, shape [h, w].
        rim: what votes, shape [h, w].
        directions: of the borders around.

    Returns:
        The area with the most votes, shape [h, w]; what it says outside of the hole means nothing.
    """
    row, column = np.nonzero(rim)
    areas, number = np.unique(labels[row, column].astype(np.int64), return_inverse=True)
    area, bound = np.eye(len(areas), dtype=np.float32)[number], np.reciprocal(_sizes(labels, hole)[row, column] ** 2)
    voters = _Voters(column.astype(np.float32), row.astype(np.float32), area, bound)
    step = _COARSE
    while hole.sum() > _SQUARES * step**2:
        step *= 2
    grouped, asked = voters.grouped(step), squares_with(hole, step)
    coarse = np.zeros((*asked.shape, len(areas)), dtype=np.float32)
    for part in _parts(asked):
        coarse[part] = _votes(part, step, directions, grouped)
    depth = cv2.distanceTransform(hole.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    fine = []
    for tile in _tiles(squares_with(hole & (depth <= _SHALLOW), _FINE)):
        sides = (edge(at) * _FINE + way * _WITHIN for at in tile[::-1] for edge, way in ((np.min, -1), (np.max, 1)))
        near = voters.within(*(int(side) for side in sides))
        if len(near.x):
            fine.append((tile, _votes(tile, _FINE, directions, near)))
    best, most = np.zeros((2, *labels.shape), dtype=np.float32)
    # One area after the other: of a large picture all of them together would take gigabytes.
    for k in range(len(areas)):
        plane = _enlarged(coarse[..., k], step // _FINE)
        for tile, votes in fine:
            plane[tile] = votes[:, k]
        plane = _enlarged(plane, _FINE)[: labels.shape[0], : labels.shape[1]]
        wins = plane > most if k else np.ones(labels.shape, dtype=bool)
        best[wins], most[wins] = k, plane[wins]
    return areas[best.astype(np.int64)].astype(np.int32)


def _sizes(labels: IntImage, hole: Mask) -> FloatImage:
    """How far from the hole what each pixel is a part of reaches [px], shape [h, w]; infinite if out of sight."""
    labels, known = labels[::_FINE, ::_FINE], ~hole[::_FINE, ::_FINE]
    away = _FINE * cv2.distanceTransform(known.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    away[[0, -1]] = away[:, [0, -1]] = np.inf
    sizes = np.full(labels.shape, np.inf, dtype=np.float32)
    for k in np.unique(labels[known]):
        own = known & (labels == k)
        count, parts = cv2.connectedComponents(own.astype(np.uint8), connectivity=4)
        most = np.zeros(count, dtype=np.float32)
        np.maximum.at(most, parts[own], away[own])
        sizes[own] = most[parts[own]]
    return np.maximum(cv2.resize(sizes, hole.shape[::-1], interpolation=cv2.INTER_NEAREST), np.float32(1))


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


def _votes(at: tuple[IntArray, IntArray], step: int, directions: Directions, voters: _Voters) -> FloatArray:
    """Logarithms of the votes for the pixels in the middle of squares, shape [n, k]."""
    down, right = ((each * step + np.float32(step / 2 - 0.5)).astype(np.float32) for each in at)
    # Across the borders' way distances are stretched, the more the more the borders run one way.
    xx, xy, yy = np.float32(_ASIDE**2 - 1) * directions.across(right, down).T
    xx, yy = xx + 1, yy + 1
    # The squared distance as a sum of products, about the middle of the places asked.
    middle = right.mean(), down.mean()
    right, down, x, y = right - middle[0], down - middle[1], voters.x - middle[0], voters.y - middle[1]
    own = [
        xx, 2 * xy, yy, -2 * (xx * right + xy * down), -2 * (xy * right + yy * down),
        xx * right * right + 2 * xy * right * down + yy * down * down,
    ]  # fmt: skip
    far = np.stack(own, axis=1) @ np.stack([x * x, x * y, y * y, x, y, np.ones_like(x)]).astype(np.float32)
    np.maximum(far, 0, out=far)
    far += np.float32(_NEAREST**2)
    bounded = far * voters.bound
    bounded += 1
    far *= far
    far *= bounded
    np.reciprocal(far, out=far)
    return np.asarray(np.log(np.maximum(far @ voters.area, np.float32(_LEAST))))


def _enlarged(votes: FloatArray, times: int) -> FloatArray:
    size = votes.shape[1] * times, votes.shape[0] * times
    return np.asarray(cv2.resize(np.ascontiguousarray(votes), size, interpolation=cv2.INTER_LINEAR))
