"""Lines and edges that enter a hole on one side and leave it on another are drawn through it.

Along the rim of the hole every line or edge is found by its structure tensor and followed outwards, which gives its
direction and its profile, the colours across it. Ends fit together when one smooth arc joins them and their profiles
agree; a narrow strip with the profiles' blend then runs along a cubic curve from one end to the other.

The pairing of level lines across a hole follows Masnou and Morel, "Level Lines Based Disocclusion" (1998).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .line_end import HALF_WIDTH, LineEnd
from .line_ends import DISTANCE, line_ends

__all__ = ["continue_lines"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]
Mask = NDArray[np.bool_]

# tests/benchmarks/line_thresholds.py measures half and twice each threshold on holes cut into the example and a sample:
# _ASYMMETRY, _RELATIVE, _LARGEST_COST, _DISTINCT and _BAND decide how much is drawn, from nothing to four times as
# much; _BEND, _DIFFERENCE, _ELSEWHERE, _CROSSING, _SHORTEST_GAP and _FALL change it by a fifth at most.

# How much each of these counts as a cost of one: the bend of an arc, and what its two halves bend differently
# [radians]; how much the mean colours differ (in 0 to 1), and the profiles about them, as a share of their contrast.
_BEND = np.deg2rad(40)
_ASYMMETRY = np.deg2rad(6)
_DIFFERENCE = 0.2
_RELATIVE = 0.4
_LARGEST_COST = 2.2
# An end that fits another nearly as well, as in a pattern, does not tell where its line goes on. The second best
# counts as different if it lies further from the best than this [px].
_DISTINCT = 0.6
_ELSEWHERE = 5.0
# The borders of a band are parallel (cosine of their angle) and no further apart than this [px].
_PARALLEL = 0.97
_BAND = 24.0
# This share of a line's way lies in the hole.
_MOSTLY = 0.8
# Lines may cross each other where both fit as well as this.
_CROSSING = 0.7
# Ends closer than this are one line's [px].
_SHORTEST_GAP = 8.0
_SAMPLING = 0.5
# The middles of two ends may be found this far from each other's [px].
_ASIDE = np.arange(-3, 3.25, 0.5)
# Weight of the strip falls with the distance from its middle.
_FALL = 3.0


@dataclass(frozen=True, eq=False)
class _Bridge:
    """A pair of ends, their numbers, with the curve that joins them, shape [n, 2], and what it costs."""

    numbers: tuple[int, int]
    ends: tuple[LineEnd, LineEnd]
    curve: FloatArray
    cost: float


def continue_lines(picture: FloatImage, hole: Mask) -> tuple[FloatImage, Mask]:
    """Draw lines and edges through a hole, where both of their ends are seen.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        hole: true where colours are unknown, shape [h, w].

    Returns:
        The picture with strips along the continued lines, shape [h, w, 3], and where in the hole these are.
    """
    total = np.zeros((*hole.shape, 4), dtype=np.float32)
    ends = line_ends(picture, hole)
    for bridge in _whole_bands(_bridges(ends, hole), ends):
        _draw(total, bridge)
    drawn = hole & (total[..., 3] > 1e-3)
    continued = picture.copy()
    continued[drawn] = (total[..., :3][drawn] / total[..., 3:][drawn]).astype(np.float32)
    return continued, drawn


def _bridges(ends: list[LineEnd], hole: Mask) -> list[_Bridge]:
    """The cheapest pairs of ends, each end used once, that do not cross each other."""
    found = []
    for i, j, cost, aside in _pairs(ends):
        pair = ends[i], ends[j].moved(aside)
        found.append(_Bridge((i, j), pair, _curve(*pair), cost))
    taken: list[_Bridge] = []
    used: set[int] = set()
    crossed = np.full(hole.shape, np.inf)
    for bridge in sorted(found, key=lambda each: each.cost):
        pixels = _pixels(bridge.curve, hole.shape)
        if used & set(bridge.numbers) or not _within(bridge.curve, hole) or _crosses(crossed, pixels, bridge.cost):
            continue
        taken.append(bridge)
        used.update(bridge.numbers)
        crossed[pixels] = bridge.cost
    return taken


def _within(curve: FloatArray, hole: Mask) -> bool:
    """Whether most of a curve lies in the hole, but for its ends, which are looked for beside it."""
    ends = int(DISTANCE / _SAMPLING)
    return bool(hole[_pixels(curve[ends:-ends], hole.shape)].mean() > _MOSTLY) if len(curve) > 2 * ends else False


def _whole_bands(bridges: list[_Bridge], ends: list[LineEnd]) -> list[_Bridge]:
    """Without the bridges beside which, at either end, a parallel line stops at the hole.

    The colours of a band of which only one border goes on would flow out of it.
    """
    kept = bridges
    while True:
        taken = {number for bridge in kept for number in bridge.numbers}
        lone = [end for number, end in enumerate(ends) if number not in taken]
        remaining = [bridge for bridge in kept if not any(_beside(ends[k], lone) for k in bridge.numbers)]
        if len(remaining) == len(kept):
            return kept
        kept = remaining


def _beside(end: LineEnd, others: list[LineEnd]) -> bool:
    """Whether any of the others runs along the same way close to an end."""
    return any(abs(end.direction @ other.direction) > _PARALLEL and end.distance(other) < _BAND for other in others)


def _crosses(taken: FloatArray, pixels: tuple[IndexArray, IndexArray], cost: float) -> bool:
    """Whether a line crosses one already taken, the costs of which are given, without both being certain."""
    others = taken[pixels]
    there = np.isfinite(others)
    return bool(there.any()) and max(cost, float(others[there].max())) > _CROSSING


def _pairs(ends: list[LineEnd]) -> list[tuple[int, int, float, float]]:
    """Numbers of ends that fit each other best by far, their costs, and how far the second lies aside [px]."""
    costs, aside = np.full((len(ends), len(ends)), np.inf), np.zeros((len(ends), len(ends)))
    for j, b in enumerate(ends):
        for i, a in enumerate(ends[:j]):
            costs[i, j], aside[i, j] = _fit(a, b)
            costs[j, i] = costs[i, j]
    places = np.array([end.position for end in ends]).reshape(-1, 2)
    elsewhere = np.linalg.norm(places[:, None] - places, axis=2) > _ELSEWHERE
    found = []
    for i, j in zip(*np.nonzero(np.triu(costs < _LARGEST_COST)), strict=True):
        rivals = (costs[i][elsewhere[j]], costs[j][elsewhere[i]])
        rests = min(*ends[i].reach, *ends[j].reach) > 0
        if rests and costs[i, j] <= _DISTINCT * min(float(each.min(initial=np.inf)) for each in rivals):
            found.append((i, j, costs[i, j], aside[i, j]))
    return found


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


def _curve(a: LineEnd, b: LineEnd) -> FloatArray:
    """Cubic from one end to the other with their directions [px], shape [n, 2]."""
    gap = float(np.linalg.norm(b.position - a.position))
    t = np.linspace(0, 1, int(gap / _SAMPLING) + 2)[:, None]
    start, end = gap * a.direction, -gap * b.direction
    return np.asarray(
        (2 * t**3 - 3 * t**2 + 1) * a.position
        + (t**3 - 2 * t**2 + t) * start
        + (3 * t**2 - 2 * t**3) * b.position
        + (t**3 - t**2) * end
    )


def _pixels(points: FloatArray, shape: tuple[int, ...]) -> tuple[IndexArray, IndexArray]:
    column, row = np.floor(points).astype(np.int64).T
    return np.clip(row, 0, shape[0] - 1), np.clip(column, 0, shape[1] - 1)


def _draw(total: FloatImage, bridge: _Bridge) -> None:
    """Add a strip, its weight in the last channel."""
    curve = bridge.curve
    tangent = np.gradient(curve, axis=0)
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-9)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    a, b = bridge.ends
    offsets = np.arange(-min(a.reach[0], b.reach[1]), min(a.reach[1], b.reach[0]) + _SAMPLING / 2, _SAMPLING)
    points = (curve[:, None] + offsets[:, None] * normal[:, None]).reshape(-1, 2)
    t = np.linspace(0, 1, len(curve))[:, None, None]
    profile = (1 - t) * a.across(offsets) + t * b.across(-offsets)
    weight = np.broadcast_to(np.exp(-((offsets / _FALL) ** 2) / 2), (len(curve), len(offsets))).reshape(-1, 1)
    values = np.concatenate([profile.reshape(-1, 3) * weight, weight], axis=1)
    height, width = total.shape[:2]
    left = np.floor(points - 0.5).astype(np.int64)
    part = points - 0.5 - left
    for down in (0, 1):
        for right in (0, 1):
            column, row = left[:, 0] + right, left[:, 1] + down
            share = (part[:, 0] if right else 1 - part[:, 0]) * (part[:, 1] if down else 1 - part[:, 1])
            within = (row >= 0) & (row < height) & (column >= 0) & (column < width)
            np.add.at(total, (row[within], column[within]), values[within] * share[within, None])
