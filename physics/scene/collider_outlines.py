"""Outlines of colliders as far as bodies can come.

A ground may be drawn a million pixels wide. What lies more than some sides from the picture and the bodies is laid
flat on the border of a window around them, so that what follows does not grow with it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..interruption import checkpoint
from ..limits import MAX_OUTLINE_POINTS
from ..mesh import area_of, contours_at_half, resampled
from ..rig import MaskRegion, farthest_led
from .collision import Collider
from .scene import Body, Scene

__all__ = [
    "LEAST_SPACING",
    "MAX_OUTLINE_CROSSINGS",
    "OutlineCounts",
    "Window",
    "count_outlines",
    "outlines",
    "spacing_of",
    "window_of",
]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]

LEAST_SPACING = 2.0
"""Smallest distance between the points of a collider's outline [px]."""

MAX_OUTLINE_CROSSINGS = 2**22
"""Pixel edges between painted and empty, of all colliders' masks together: beyond, masks are noise."""

_CROWD = 3.0  # spacings, about as far as a search for contacts looks around
_AROUND = 2.0  # [side] that bodies may leave the picture or their places, besides where they are led
_FARTHEST = 4.0  # [side] at most: nobody sees what touches out there
_SMALLEST_COLLIDER = 4.0  # [px^2]
_PIXELS_AT_ONCE = 1 << 22


class Window(NamedTuple):
    """Where bodies may touch something: the low and the high corner of a box [px], each of shape [2]."""

    low: FloatArray
    high: FloatArray


def window_of(scene: Scene) -> Window:
    """Where the bodies of a scene can come, generously."""
    side = scene.bodies[0].mesh.longest_side
    lows = [body.mesh.vertices.min(axis=0) for body in scene.bodies]
    highs = [body.mesh.vertices.max(axis=0) for body in scene.bodies]
    low, high = np.minimum(np.min(lows, axis=0), 0.0), np.maximum(np.max(highs, axis=0), [scene.width, scene.height])
    led = max((farthest_led(point, low, high) for point in scene.rig_points), default=0.0)
    reach = min(_AROUND * side + led, _FARTHEST * side)
    return Window(low - reach, high + reach)


def outlines(collider: Collider, width: int, height: int, spacing: float, window: Window) -> list[FloatArray]:
    """Closed outlines wound as mesh boundaries are, their points a spacing apart [px], each of shape [n, 2].

    Args:
        collider: the shape.
        width: of the picture [px].
        height: of the picture [px].
        spacing: between points [px].
        window: beyond it a polygon is laid flat on its border.
    """
    if isinstance(collider.region, MaskRegion):
        mask = collider.region.mask
        scale = np.array([width, height]) / mask.shape[::-1]
        found = contours_at_half(np.pad(mask, 1))
        loops = [(loop - 1.0) * scale for loop in found if abs(area_of(loop)) >= _SMALLEST_COLLIDER]
    else:
        loops = _polygon(collider, window)
    checkpoint()
    return [_sampled(loop, spacing) for loop in loops]


def spacing_of(bodies: Sequence[Body]) -> float:
    """Distance of the points of colliders' outlines [px]: that of the bodies' boundary vertices."""
    lengths = []
    for body in bodies:
        ends = body.mesh.vertices[body.mesh.boundary_edges]
        lengths.append(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))
    return max(float(np.median(np.concatenate(lengths))), LEAST_SPACING)


class OutlineCounts(NamedTuple):
    """How much the outlines of all colliders are, about.

    Attributes:
        points: points of all outlines, where bodies can come.
        crossings: pixel edges that the outlines of masks follow.
        crowding: pairs of points that lie in the same small square: a search meets every one of them.
    """

    points: int
    crossings: int
    crowding: int


def count_outlines(scene: Scene, spacing: float) -> OutlineCounts:
    """Measure the outlines of a scene's colliders without preparing them.

    Args:
        scene: the scene.
        spacing: between points [px].
    """
    window, points, crossings = window_of(scene), 0.0, 0
    crowd: dict[int, float] = {}
    for collider in scene.colliders:
        checkpoint()
        if isinstance(collider.region, MaskRegion):
            mask = collider.region.mask
            scale = np.array([scene.width / mask.shape[1], scene.height / mask.shape[0]])
            found = _crossings(mask)
            crossings += found
            points += min(found, found * scale.max() / spacing)
            if crossings <= MAX_OUTLINE_CROSSINGS:
                share = min(1.0, float(scale.max()) / spacing)
                _add_to(crowd, _crossing_places(mask) * scale, share, spacing)
            continue
        for loop in _polygon(collider, window):
            points += _points_of(loop, spacing)
            if points <= MAX_OUTLINE_POINTS:
                _add_to(crowd, _sampled(loop, spacing), 1.0, spacing)
    return OutlineCounts(math.ceil(points), crossings, math.ceil(sum(count * count for count in crowd.values())))


def _add_to(crowd: dict[int, float], places: FloatArray, share: float, spacing: float) -> None:
    """Count places by the small squares in which they lie, each as a share of a point."""
    squares = np.floor(places / (_CROWD * spacing)).astype(np.int64)
    # One number for both: whole rows are compared under Python's global lock, which stops everything else.
    numbers, counts = np.unique((squares[:, 0] << 32) + squares[:, 1], return_counts=True)
    for number, count in zip(numbers.tolist(), counts.tolist(), strict=True):
        crowd[number] = crowd.get(number, 0.0) + share * count


def _crossing_places(mask: NDArray[np.bool_]) -> FloatArray:
    """Where the outline of a mask passes between two pixels, in its pixels, shape [n, 2]."""
    places, rows = [np.zeros((0, 2))], max(1, _PIXELS_AT_ONCE // mask.shape[1])
    for first in range(0, len(mask), rows):
        checkpoint()
        some = mask[first : first + rows + 1]
        for differing in (some[:rows, 1:] != some[:rows, :-1], some[1:] != some[:-1]):
            row, column = np.divmod(np.flatnonzero(differing), max(1, differing.shape[1]))
            places.append(np.column_stack([column, row + first]).astype(np.float64))
    return np.concatenate(places)


def _crossings(mask: NDArray[np.bool_]) -> int:
    """Between how many neighbouring pixels a mask's outline passes."""
    across, rows = 0, max(1, _PIXELS_AT_ONCE // mask.shape[1])
    for first in range(0, len(mask), rows):
        checkpoint()
        some = mask[first : first + rows + 1]
        across += int(np.count_nonzero(some[1:] != some[:-1]))
        across += int(np.count_nonzero(some[:rows, 1:] != some[:rows, :-1]))
    return across + int(sum(np.count_nonzero(border) for border in (mask[0], mask[-1], mask[:, 0], mask[:, -1])))


def _polygon(collider: Collider, window: Window) -> list[FloatArray]:
    """A polygon's corners in the winding of mesh boundaries, none of them beyond the window."""
    loop = np.array(collider.region.points)  # type: ignore[union-attr]
    loop = loop if area_of(loop) < 0 else loop[::-1]
    if (loop >= window.low).all() and (loop <= window.high).all():
        return [loop]
    for axis in range(2):
        for level in (window.low[axis], window.high[axis]):
            loop = _cut_at(loop, axis, level)
    loop = np.clip(loop, window.low, window.high)
    loop = loop[(loop != np.roll(loop, 1, axis=0)).any(axis=1)]
    return [loop] if len(loop) >= 3 and abs(area_of(loop)) > 0 else []


def _cut_at(loop: FloatArray, axis: int, level: float) -> FloatArray:
    """A polygon with a further corner wherever an edge passes a coordinate."""
    following = np.roll(loop, -1, axis=0)
    a, b = loop[:, axis], following[:, axis]
    passing = ((a < level) & (b > level)) | ((a > level) & (b < level))
    share = np.divide(level - a, b - a, out=np.zeros_like(a), where=passing)
    added = (loop + (following - loop) * share[:, None])[passing]
    added[:, axis] = level
    return np.insert(loop, np.flatnonzero(passing) + 1, added, axis=0)


def _points_of(loop: FloatArray, spacing: float) -> float:
    lengths = np.linalg.norm(np.roll(loop, -1, axis=0) - loop, axis=1)
    if np.median(lengths) < spacing / 2:
        return float(lengths.sum() / spacing) + 3
    return float(np.ceil(lengths / spacing).sum())


def _sampled(loop: FloatArray, spacing: float) -> FloatArray:
    """A polygon with its corners kept and long edges divided, or a dense one thinned out."""
    lengths = np.linalg.norm(np.roll(loop, -1, axis=0) - loop, axis=1)
    if np.median(lengths) < spacing / 2:
        return resampled(loop, lambda points: np.full(len(points), spacing))
    closed: Sequence[FloatArray] = [*loop, loop[0]]
    pieces = [
        a + (b - a) * (np.arange(n) / n)[:, None]
        for (a, b), n in zip(pairwise(closed), np.ceil(lengths / spacing).astype(int), strict=True)
        if n
    ]
    return np.concatenate(pieces)
