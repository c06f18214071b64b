"""Flow particles: where the particles of energy strokes are, and how they accelerate what is near them.

Paper, Appendix "Details of Interactive Animation". The paper's forces act here per mass, so that the motion does
not depend on the mesh, and end at the radius, where wind and attract would otherwise reverse their sign.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .strokes import ROUNDING, EnergyStroke
from .travel import factors

__all__ = ["Particles", "acceleration", "all_particles", "most_alive", "particles", "particles_at"]

FloatArray = NDArray[np.float64]

_NOTHING = np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0)


class Particles(NamedTuple):
    """The particles of several strokes at one time, in the form that a kernel reads.

    Attributes:
        kind: kind and falloff as in ``EnergyStroke.effect_number``, int32, shape [p].
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

    Examples:
        >>> from physanimator.physics.forces import EnergyStroke, particles
        >>> positions, directions = particles(EnergyStroke("wind", path=((0, 0), (100, 0)), speed=50.0), t=1.0)
        >>> positions[0].tolist(), directions[0].tolist()
        ([50.0, 0.0], [1.0, 0.0])
    """
    positions, directions, _ = _placed(stroke, _all_ages(stroke, t))
    return positions, directions


def _placed(stroke: EnergyStroke, ages: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Positions, directions, and the factor on the strength of particles of some ages [s], shape [p]."""
    path = stroke.polyline
    if stroke.rests:
        directions = path.directions[:1] if len(path.directions) else np.zeros((1, 2))
        first = np.zeros(len(ages), dtype=np.int64)
        return path.points[first], directions[first], factors(stroke.strength_keys, np.zeros(len(ages)))
    distances = stroke.travel.distance(ages)
    segments = np.searchsorted(path.arc_lengths[1:-1], distances, side="right")
    directions = path.directions[segments]
    offsets = distances - path.arc_lengths[segments]
    strengths = factors(stroke.strength_keys, distances / path.length)
    return path.points[segments] + offsets[:, None] * directions, directions, strengths


def all_particles(strokes: Sequence[EnergyStroke], t: float) -> Particles:
    """The particles of several strokes that are alive at a time, in the order of the strokes.

    Args:
        strokes: the strokes.
        t: time [s].
    """
    return particles_at(strokes, (t,))[0]


def particles_at(strokes: Sequence[EnergyStroke], times: Iterable[float]) -> tuple[Particles, NDArray[np.int64]]:
    """The particles of several strokes that are alive at some times, one time after the other.

    Args:
        strokes: the strokes.
        times: [s], n of them.

    Returns:
        The particles of each time in the order of the strokes, and how many there are at each time, shape [n].
    """
    times = [float(t) for t in times]
    ages = [[_all_ages(stroke, t) for t in times] for stroke in strokes]
    counts = np.array([[len(group) for group in groups] for groups in ages], dtype=np.int64).reshape(-1, len(times))
    order = np.argsort(np.repeat(np.tile(np.arange(len(times)), len(strokes)), counts.ravel()), kind="stable")
    placed = [_placed(stroke, np.concatenate(groups)) for stroke, groups in zip(strokes, ages, strict=True) if groups]
    position, direction, along = (
        np.concatenate([nothing, *parts])[order]
        for nothing, parts in zip(_NOTHING, zip(*placed, strict=True) if placed else ((), (), ()), strict=True)
    )
    kinds = [stroke.effect_number for stroke in strokes]
    of_stroke = np.repeat(np.arange(len(strokes)), counts.sum(axis=1))[order]
    radius, strength = (np.array([getattr(s, name) for s in strokes], dtype=float) for name in ("radius", "strength"))
    found = Particles(
        kind=np.array(kinds, dtype=np.int32)[of_stroke],
        position=position,
        direction=direction,
        radius=radius[of_stroke],
        strength=strength[of_stroke] * along,
    )
    return found, counts.sum(axis=0)


def acceleration(stroke: EnergyStroke, points: FloatArray, t: float) -> FloatArray:
    """Acceleration that a stroke gives to each point: the sum over its particles.

    With particle p, point q, d = |q - p|, radius r, strength s and direction of travel e, for d <= r:
    wind s (1 - d/r) e, repel s (q - p) / r, attract s (1 - d/r) (p - q) / d; nothing beyond r, and no
    pull at p = q, where it has no direction. Another falloff than linear takes the place of 1 - d/r, and with it
    repel is s f (q - p) / d. The strength s is times its key's factor where the particle is.

    Args:
        stroke: the stroke.
        points: [px], shape [n, 2].
        t: time [s].

    Returns:
        [side/s^2], shape [n, 2].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.forces import EnergyStroke, acceleration
        >>> stroke = EnergyStroke("wind", path=((0, 0), (100, 0)), radius=20.0, speed=50.0)
        >>> pushed, free = acceleration(stroke, np.array([[50.0, 5.0], [50.0, 500.0]]), t=1.0)
        >>> bool(pushed[0] > 0), free.tolist()
        (True, [0.0, 0.0])
    """
    points = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    total = np.zeros_like(points)
    for position, direction, factor in zip(*_placed(stroke, _all_ages(stroke, t)), strict=True):
        offset = points - position
        distance = np.hypot(offset[:, 0], offset[:, 1])
        near = np.flatnonzero(distance <= stroke.radius)
        total[near] += stroke.strength * factor * _effect(stroke, offset[near], distance[near], direction)
    return total


def most_alive(stroke: EnergyStroke, *, horizon: float = math.inf) -> int:
    """The largest number of a stroke's particles that are alive at any one time up to a horizon.

    Args:
        stroke: the stroke.
        horizon: time up to which to look [s].
    """
    if horizon < stroke.start:
        return 0
    if stroke.repeat is not None:
        return int(stroke.most_particles)
    emitted = math.floor((horizon - stroke.start) / stroke.interval + ROUNDING) + 1 if horizon < math.inf else math.inf
    return int(min(stroke.most_particles, emitted))


def _emits(stroke: EnergyStroke, t: float) -> bool:
    """Whether a time lies from ``start`` to before ``end``, or in a repetition of that."""
    if t < stroke.start:
        return False
    since = t - stroke.start
    if stroke.repeat is not None:
        since -= math.floor(since / stroke.repeat + ROUNDING) * stroke.repeat
    return stroke.end is None or since < stroke.end - stroke.start


def _all_ages(stroke: EnergyStroke, t: float) -> FloatArray:
    """How long ago each living particle left, those of every repetition [s], the oldest first, shape [p]."""
    if stroke.rests:
        return np.zeros(int(_emits(stroke, t)))
    if stroke.repeat is None or stroke.end is None:
        return _ages(stroke, t)
    window, since = stroke.end - stroke.start, t - stroke.start
    last = math.floor(since / stroke.repeat + ROUNDING)
    first = max(0, math.floor((since - window - stroke.travel.lifetime) / stroke.repeat))
    each = [_ages(stroke, t - number * stroke.repeat) for number in range(first, last + 1)]
    return np.concatenate(each) if each else np.zeros(0)


def _ages(stroke: EnergyStroke, t: float) -> FloatArray:
    """How long ago each living particle of the first repetition left [s], the oldest first, shape [p]."""
    age = (t - stroke.start) / stroke.interval  # of the first particle, in intervals
    lifetime = min(stroke.travel.lifetime / stroke.interval, 1e12)  # a crawling particle may outlive every float
    first = max(0, math.floor(age - lifetime + ROUNDING) + 1)
    last = min(math.floor(age + ROUNDING), stroke.emissions - 1)
    return t - stroke.start - np.arange(first, last + 1) * stroke.interval


def _effect(stroke: EnergyStroke, offset: FloatArray, distance: FloatArray, direction: FloatArray) -> FloatArray:
    """Effect of one particle at strength 1 on points within its radius, shape [n, 2]."""
    nearness = distance / stroke.radius
    if stroke.kind == "repel" and stroke.falloff == "linear":
        return offset / stroke.radius
    profiles = {"linear": 1.0 - nearness, "smooth": (1.0 - nearness**2) ** 2, "constant": np.ones_like(nearness)}
    falling = profiles[stroke.falloff]
    if stroke.kind == "wind":
        return falling[:, None] * direction
    away = np.divide(offset, distance[:, None], out=np.zeros_like(offset), where=distance[:, None] > 0)
    return falling[:, None] * (away if stroke.kind == "repel" else -away)
