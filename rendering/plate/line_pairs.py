"""Which ends of lines belong together: one smooth arc joins them, and the colours across them agree."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .line_end import HALF_WIDTH, LineEnd

__all__ = ["fitting_pairs"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]
Mask = NDArray[np.bool_]

# tests/benchmarks/thresholds.py measures half and twice each threshold on holes cut into the example and a sample:
# _ASYMMETRY, _RELATIVE, _LARGEST_COST and _DISTINCT decide how much is drawn, from nothing to four times as much;
# _BEND, _DIFFERENCE, _ELSEWHERE and _SHORTEST_GAP change it by a fifth at most.

# The cost of a pair is the root of a sum of squares. Each of these is where one term is 1: the bend of the arc, and the
# difference between the bends of its two halves [radians]; the difference of the mean colours (in 0 to 1), and that of
# the profiles about their means, as a share of their contrast.
_BEND = np.deg2rad(40)
_ASYMMETRY = np.deg2rad(6)
_DIFFERENCE = 0.2
_RELATIVE = 0.4
_LARGEST_COST = 2.2
# An end that fits another nearly as well, as in a pattern, does not tell where its line goes on. The second best
# counts as different if it lies further from the best than this [px].
_DISTINCT = 0.6
_ELSEWHERE = 5.0
# Ends closer than this are one line's [px].
_SHORTEST_GAP = 8.0
# What angles of many pairs at once may differ by from those of one.
_ROUNDING = 1e-9
# The middle of a line is found only roughly: profiles are compared shifted by each of these [px].
_ASIDE = np.arange(-3, 3.25, 0.5)


def fitting_pairs(ends: list[LineEnd]) -> list[tuple[int, int, float, float]]:
    """The pairs of ends that fit each other best by far.

    Args:
        ends: of lines and edges around a hole.

    Returns:
        For each pair the numbers of both ends, its cost, and how far aside the middle of the second is moved [px].
    """
    costs, aside = np.full((len(ends), len(ends)), np.inf), np.zeros((len(ends), len(ends)))
    places = np.array([end.position for end in ends]).reshape(-1, 2)
    for i, j in _smooth_pairs(places, np.array([end.direction for end in ends]).reshape(-1, 2)):
        costs[i, j], aside[i, j] = _fit(ends[i], ends[j])
        costs[j, i] = costs[i, j]
    elsewhere = np.linalg.norm(places[:, None] - places, axis=2) > _ELSEWHERE
    found = []
    for i, j in zip(*np.nonzero(np.triu(costs < _LARGEST_COST)), strict=True):
        rivals = (costs[i][elsewhere[j]], costs[j][elsewhere[i]])
        rests = min(*ends[i].reach, *ends[j].reach) > 0
        if rests and costs[i, j] <= _DISTINCT * min(float(each.min(initial=np.inf)) for each in rivals):
            found.append((i, j, costs[i, j], aside[i, j]))
    return found


def _smooth_pairs(places: FloatArray, directions: FloatArray) -> IndexArray:
    """Pairs of ends that an arc joins that bends little enough, with few that do not, shape [n, 2]; i below j."""
    way = places[None] - places[:, None]
    start, end = _angles(directions[:, None], way), _angles(way, -directions[None])
    bend, asymmetry = np.maximum(np.abs(start), np.abs(end)) / _BEND, np.abs(start - end) / _ASYMMETRY
    return np.argwhere(np.triu(np.maximum(bend, asymmetry) <= _LARGEST_COST * (1 + _ROUNDING), 1))


def _angles(one: FloatArray, other: FloatArray) -> FloatArray:
    """Signed angles from directions to others [radians], shape [i, j] of [i, j, 2] each."""
    turn = one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]
    return np.asarray(np.arctan2(turn, (one * other).sum(axis=-1)))


def _fit(a: LineEnd, b: LineEnd) -> tuple[float, float]:
    """How badly two ends fit together, infinite where they cannot; and how far ``b`` lies aside [px]."""
    way = b.position - a.position
    gap = float(np.linalg.norm(way))
    if gap < _SHORTEST_GAP:
        return np.inf, 0.0
    bends = _angle(a.direction, way), _angle(way, -b.direction)
    bend, asymmetry = max(map(abs, bends)) / _BEND, abs(bends[0] - bends[1]) / _ASYMMETRY
    if max(bend, asymmetry) > _LARGEST_COST:
        return np.inf, 0.0
    at = np.arange(-HALF_WIDTH, HALF_WIDTH + 1.0)
    difference = a.across(at) - b.across(-at - _ASIDE[:, None])
    mean = difference.mean(axis=1)
    shape = np.sqrt(((difference - mean[:, None]) ** 2).sum(axis=2).mean(axis=1)) / min(a.contrast, b.contrast)
    unlike = np.hypot(np.linalg.norm(mean, axis=1) / _DIFFERENCE, shape / _RELATIVE)
    best = int(np.argmin(unlike))
    return float(np.hypot(np.hypot(bend, asymmetry), unlike[best])), -float(_ASIDE[best])


def _angle(one: FloatArray, other: FloatArray) -> float:
    """Signed angle from one direction to another [radians]."""
    return float(np.arctan2(one[0] * other[1] - one[1] * other[0], one @ other))
