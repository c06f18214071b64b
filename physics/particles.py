"""Flow particles: where the particles of energy strokes are, and how they accelerate what is near them.

Paper, Appendix "Details of Interactive Animation". The paper's forces act here per mass, so that the motion does
not depend on the mesh, and end at the radius, where wind and attract would otherwise reverse their sign.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .strokes import ROUNDING, STROKE_KINDS, EnergyStroke

__all__ = ["Particles", "acceleration", "all_particles", "most_alive", "particles"]

FloatArray = NDArray[np.float64]


class Particles(NamedTuple):
    """The particles of several strokes at one time, in the form that a kernel reads.

    Attributes:
        kind: index into ``STROKE_KINDS`` (0 wind, 1 repel, 2 attract), int32, shape [p].
        position: [px], shape [p, 2].
        direction: unit direction of travel, shape [p, 2]; (0, 0) for a path without a length.
        radius: [px], shape [p].
        strength: [side/s^2], shape [p].
    """

    kind: NDArray[np.int32]
    position: FloatArray
    direction: FloatArray
    radius: FloatArray
    strength: FloatArray


def particles(stroke: EnergyStroke, t: float) -> tuple[FloatArray, FloatArray]:
    """The particles of a stroke that are alive at a time.

    A particle is alive from the moment that it leaves (inclusive) until it reaches the last point (exclusive); a
    resting one from ``start`` (inclusive) until ``end`` (exclusive). The oldest comes first.

    Args:
        stroke: the stroke.
        t: time [s].

    Returns:
        Positions [px], shape [p, 2], and unit directions of travel, shape [p, 2]. At a corner the direction is that
        of the segment ahead; a resting particle has that of the first segment, and (0, 0) on a path without one.
    """
    path = stroke.polyline
    if stroke.rests:
        alive = stroke.start <= t and (stroke.end is None or t < stroke.end)
        directions = path.directions[:1] if len(path.directions) else np.zeros((1, 2))
        return path.points[: int(alive)], directions[: int(alive)]
    distances = _distances(stroke, t)
    segments = np.searchsorted(path.arc_lengths[1:-1], distances, side="right")
    directions = path.directions[segments]
    offsets = distances - path.arc_lengths[segments]
    return path.points[segments] + offsets[:, None] * directions, directions


def all_particles(strokes: Sequence[EnergyStroke], t: float) -> Particles:
    """The particles of several strokes that are alive at a time, in the order of the strokes.

    Args:
        strokes: the strokes.
        t: time [s].
    """
    each = [particles(stroke, t) for stroke in strokes]
    counts = [len(positions) for positions, _ in each]
    nothing = [np.zeros((0, 2))]
    return Particles(
        kind=np.repeat(np.array([STROKE_KINDS.index(s.kind) for s in strokes], dtype=np.int32), counts),
        position=np.concatenate([positions for positions, _ in each] or nothing),
        direction=np.concatenate([directions for _, directions in each] or nothing),
        radius=np.repeat(np.array([s.radius for s in strokes], dtype=np.float64), counts),
        strength=np.repeat(np.array([s.strength for s in strokes], dtype=np.float64), counts),
    )


def acceleration(stroke: EnergyStroke, points: FloatArray, t: float) -> FloatArray:
    """Acceleration that a stroke gives to each point: the sum over its particles.

    With particle p, point q, d = |q - p|, radius r, strength s and direction of travel e, for d <= r:
    wind s (1 - d/r) e, repel s (q - p) / r, attract s (1 - d/r) (p - q) / d; nothing beyond r, and no
    pull at p = q, where it has no direction.

    Args:
        stroke: the stroke.
        points: [px], shape [n, 2].
        t: time [s].

    Returns:
        [side/s^2], shape [n, 2].
    """
    points = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    total = np.zeros_like(points)
    for position, direction in zip(*particles(stroke, t), strict=True):
        offset = points - position
        distance = np.hypot(offset[:, 0], offset[:, 1])
        near = np.flatnonzero(distance <= stroke.radius)
        total[near] += stroke.strength * _effect(stroke, offset[near], distance[near], direction)
    return total


def most_alive(stroke: EnergyStroke, *, horizon: float = math.inf) -> int:
    """The largest number of a stroke's particles that are alive at any one time up to a horizon.

    Args:
        stroke: the stroke.
        horizon: time up to which to look [s].
    """
    if horizon < stroke.start:
        return 0
    emitted = math.floor((horizon - stroke.start) / stroke.interval + ROUNDING) + 1 if horizon < math.inf else math.inf
    return int(min(stroke.most_particles, emitted))


def _distances(stroke: EnergyStroke, t: float) -> FloatArray:
    """How far each living particle has travelled [px], the oldest first, shape [p]."""
    length = stroke.polyline.length
    age = (t - stroke.start) / stroke.interval  # of the first particle, in intervals
    lifetime = min(length / stroke.speed / stroke.interval, 1e12)  # a crawling particle may outlive every float
    first = max(0, math.floor(age - lifetime + ROUNDING) + 1)
    last = min(math.floor(age + ROUNDING), stroke.emissions - 1)
    ages = t - stroke.start - np.arange(first, last + 1) * stroke.interval
    return np.clip(ages * stroke.speed, 0.0, length)


def _effect(stroke: EnergyStroke, offset: FloatArray, distance: FloatArray, direction: FloatArray) -> FloatArray:
    """Effect of one particle at strength 1 on points within its radius, shape [n, 2]."""
    if stroke.kind == "repel":
        return offset / stroke.radius
    falling = 1.0 - distance / stroke.radius
    if stroke.kind == "wind":
        return falling[:, None] * direction
    towards = np.divide(-offset, distance[:, None], out=np.zeros_like(offset), where=distance[:, None] > 0)
    return falling[:, None] * towards
