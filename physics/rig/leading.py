"""Where a rig point leads the vertices of its region: an affine motion about the point.

A vertex at rest at X goes to c + d(t) + L(t) (X - c), with c the rig point's position, d the way that its motions lead
it and L the turn and squash.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .easing import eased, eased_rate
from .regions import displacement, velocity
from .rig_point import Combined, KeyedPath, RigMotion, RigPoint, Wave
from .turns import Pulse, Rotation, Squash, Swing

__all__ = ["Lead", "farthest_led", "lead", "linear_part"]

FloatArray = NDArray[np.float64]


class Lead(NamedTuple):
    """The displacement M X + d of a region over time, and how fast it changes.

    Attributes:
        coefficients: M row by row and d, shape [n, 6]; d in the unit of the position.
        rates: their time derivatives, shape [n, 6].
    """

    coefficients: FloatArray
    rates: FloatArray


def lead(motion: RigMotion, position: tuple[float, float], t: NDArray[np.floating]) -> Lead:
    """How a motion displaces the vertices of its region from where they were drawn.

    Args:
        motion: the motion.
        position: of the rig point [px].
        t: times [s], shape [n].
    """
    linear, rate = linear_part(motion, t)
    change, centre = linear - np.eye(2), np.array(position)
    return Lead(
        np.column_stack([change.reshape(-1, 4), displacement(motion, t) - change @ centre]),
        np.column_stack([rate.reshape(-1, 4), velocity(motion, t) - rate @ centre]),
    )


def farthest_led(rig_point: RigPoint, low: FloatArray, high: FloatArray) -> float:
    """A bound on how far a rig point leads anything that lies within a box [px].

    Args:
        rig_point: the rig point.
        low: corner of the box [px], shape [2].
        high: the opposite corner.
    """
    corner = np.maximum(np.abs(low - rig_point.position), np.abs(high - rig_point.position))
    arm, way, growth = float(np.hypot(*corner)), 0.0, 1.0
    motions = rig_point.motion.motions if isinstance(rig_point.motion, Combined) else (rig_point.motion,)
    turns = False
    for motion in motions:
        if isinstance(motion, KeyedPath):
            way += float(np.hypot(*(np.array(motion.points) - motion.points[0]).T).max())
        elif isinstance(motion, Wave):
            way += 2 * abs(motion.amplitude)
        elif isinstance(motion, Rotation | Swing):
            turns = True
        elif isinstance(motion, Pulse):
            growth *= max(motion.stretch, 1 / motion.stretch) ** 2
        elif isinstance(motion, Squash):
            growth *= max(motion.factors) / min(motion.factors)
    return way + arm * (growth + 1 if turns else growth - 1 if growth > 1 else 0.0)


def linear_part(motion: RigMotion, t: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """The turn and squash L of a motion and its time derivative [1/s], each of shape [n, 2, 2].

    Args:
        motion: the motion; those that only move a region along have the identity.
        t: times [s], shape [n].
    """
    times = np.asarray(t, dtype=np.float64)
    if isinstance(motion, Combined):
        return _product([linear_part(single, times) for single in motion.motions])
    if isinstance(motion, Rotation | Swing):
        return _turn(*_angle(motion, times))
    if isinstance(motion, Squash | Pulse):
        return _stretch(motion.angle, motion.keep_area, *_logarithm(motion, times))
    return np.broadcast_to(np.eye(2), (*times.shape, 2, 2)), np.zeros((*times.shape, 2, 2))


def _product(factors: list[tuple[FloatArray, FloatArray]]) -> tuple[FloatArray, FloatArray]:
    """The linear maps one after the other, and the derivative by the product rule."""
    linear, rate = factors[0]
    for following, following_rate in factors[1:]:
        linear, rate = following @ linear, following_rate @ linear + following @ rate
    return linear, rate


def _angle(motion: Rotation | Swing, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angle [rad] and its rate [rad/s]."""
    if isinstance(motion, Swing):
        wave, rate = _wave(motion.period, motion.phase, t)
        return np.radians(motion.amplitude) * wave, np.radians(motion.amplitude) * rate
    keys = motion.times, motion.angles, motion.easing
    return np.radians(eased(*keys, t) - motion.angles[0]), np.radians(eased_rate(*keys, t))


def _logarithm(motion: Squash | Pulse, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Logarithm of the stretch and its rate [1/s]."""
    if isinstance(motion, Pulse):
        wave, rate = _wave(motion.period, motion.phase, t)
        return np.log(motion.stretch) * wave, np.log(motion.stretch) * rate
    logarithms = tuple(float(value) for value in np.log(motion.factors))
    keys = motion.times, logarithms, motion.easing
    return eased(*keys, t) - logarithms[0], eased_rate(*keys, t)


def _wave(period: float, phase: float, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """sin(2 pi t / period + phase) - sin phase, and its rate [1/s]."""
    rate, start = 2 * np.pi / period, np.radians(phase)
    return np.sin(rate * t + start) - np.sin(start), rate * np.cos(rate * t + start)


def _turn(angle: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Turning counterclockwise as seen, with y down."""
    cosine, sine = np.cos(angle), np.sin(angle)
    linear = np.stack([cosine, sine, -sine, cosine], axis=-1).reshape(*angle.shape, 2, 2)
    quarter = np.array([[0.0, 1.0], [-1.0, 0.0]])
    return linear, rate[..., None, None] * (quarter @ linear)


def _stretch(degrees: float, keep_area: bool, logarithm: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Stretching along a direction; across it by the reciprocal where the area is kept."""
    direction = np.array([np.cos(np.radians(degrees)), -np.sin(np.radians(degrees))])
    along = np.outer(direction, direction)
    across = np.eye(2) - along
    grown, shrunk = np.exp(logarithm)[..., None, None], np.exp(-logarithm * keep_area)[..., None, None]
    change = rate[..., None, None]
    return grown * along + shrunk * across, change * (grown * along - keep_area * shrunk * across)
