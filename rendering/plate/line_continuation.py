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

from .line_end import LineEnd
from .line_ends import DISTANCE, line_ends
from .line_pairs import fitting_pairs

__all__ = ["continue_lines"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]
Mask = NDArray[np.bool_]

# tests/benchmarks/thresholds.py measures half and twice each threshold on holes cut into the example and a sample:
# _BAND decides how much is drawn, _CROSSING and _FALL change it by a fifth at most.

# The borders of a band are parallel (cosine of their angle) and no further apart than this [px].
_PARALLEL = 0.97
_BAND = 24.0
# At least this share of a line's way lies in the hole.
_MOSTLY = 0.8
# Lines may cross each other where neither costs more than this.
_CROSSING = 0.7
# Steps along a curve and across it [px]; half a pixel leaves no pixel of a strip out.
_SAMPLING = 0.5
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
    for i, j, cost, aside in fitting_pairs(ends):
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
    """Drop bridges beside which a parallel line ends at the hole and is not continued.

    Both are borders of one band: with only one of them drawn through the hole, the band's colours would flow out of it.
    Dropping one may leave its neighbour alone in turn, hence the loop.
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
    """Whether a line crosses another one and either of them fits too badly for a crossing to be believed.

    Args:
        taken: cost of the line that is drawn at each pixel so far, infinite where there is none, shape [h, w].
        pixels: of the new line.
        cost: of the new line.
    """
    others = taken[pixels]
    there = np.isfinite(others)
    return bool(there.any()) and max(cost, float(others[there].max())) > _CROSSING


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
    # Summed pixel by pixel: `pictures.splat` sums in another order, which changes single pixels of the example.
    left = np.floor(points - 0.5).astype(np.int64)
    part = points - 0.5 - left
    for down in (0, 1):
        for right in (0, 1):
            column, row = left[:, 0] + right, left[:, 1] + down
            share = (part[:, 0] if right else 1 - part[:, 0]) * (part[:, 1] if down else 1 - part[:, 1])
            within = (row >= 0) & (row < height) & (column >= 0) & (column < width)
            np.add.at(total, (row[within], column[within]), values[within] * share[within, None])
