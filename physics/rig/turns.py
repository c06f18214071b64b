"""Motions of a rig point that turn and squash its region about the point, and how keyed values are eased."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, TypeVar, get_args

from ..checks import numbers_of, within
from ..errors import require
from ..limits import LARGEST
from ..points import Scale

__all__ = [
    "EASINGS",
    "MOST_DEGREES",
    "MOST_STRETCH",
    "Easing",
    "Pulse",
    "Rotation",
    "Squash",
    "Swing",
    "checked_easing",
    "checked_phase",
    "checked_times",
]

T = TypeVar("T")
Easing = Literal["smooth", "linear", "ease", "hold"]

EASINGS: tuple[str, ...] = get_args(Easing)
"""smooth: monotone cubic, no stop at the keys; linear: at even speed; ease: stops at every key; hold: stays, then jumps
within ``easing.BLEND`` seconds."""

MOST_DEGREES = 36_000
"""Largest angle: a hundred turns [degrees]."""

MOST_STRETCH = 20.0
"""Largest factor of a squash, and the reciprocal of the smallest."""

_SHORTEST = 0.001  # [s] between two keys: no speed grows beyond what a float can bear


def checked_times(times: Sequence[float], count: int, what: str) -> tuple[float, ...]:
    """The times of keys [s], if they are rising, from 0 on, and one for each value.

    Raises:
        InvalidInputError: they are not.
    """
    checked = numbers_of("times", times, "a list of numbers [s]")
    require("times", f"{len(checked)} times", len(checked) == count, f"one per {what} ({count})")
    bounded = checked[0] >= 0 and all(t <= LARGEST for t in checked)
    require("times", checked[:8], bounded, f"from 0 to {LARGEST} s")
    rising = all(b - a > _SHORTEST * (1 - 1e-6) for a, b in pairwise(checked))
    require("times", checked[:8], rising, f"increasing by at least {_SHORTEST} s from key to key")
    return checked


def checked_easing(easing: str) -> None:
    """Refuse an unknown easing."""
    require("easing", easing, isinstance(easing, str) and easing in EASINGS, f"one of {', '.join(EASINGS)}")


def checked_phase(phase: float) -> None:
    """Refuse a phase that is no angle."""
    require("phase", phase, within(phase, -MOST_DEGREES, MOST_DEGREES), f"-{MOST_DEGREES} to {MOST_DEGREES} degrees")


def _checked_angle(angle: float) -> None:
    require("angle", angle, within(angle, -MOST_DEGREES, MOST_DEGREES), f"-{MOST_DEGREES} to {MOST_DEGREES} degrees")


def _checked_period(period: float) -> None:
    require("period", period, within(period, 0.01, LARGEST), f"0.01 to {LARGEST} s")


def _checked_values(name: str, values: Sequence[float], low: float, high: float, unit: str) -> tuple[float, ...]:
    checked = numbers_of(name, values, "a list of numbers")
    require(name, f"{len(checked)} values", len(checked) >= 2, "at least 2 values")
    require(name, checked[:8], all(low <= value <= high for value in checked), f"{low:g} to {high:g}{unit}")
    return checked


class _SameAtAnySize:
    def rescaled(self: T, scale: Scale) -> T:
        """Itself: angles and factors do not depend on the picture's size."""
        return self


@dataclass(frozen=True)
class Rotation(_SameAtAnySize):
    """Turned about the rig point through keyed angles; at rest before the first and after the last.

    The region turns by the difference to the first key, so it never jumps at the start.

    Attributes:
        times: one per key [s], increasing by at least 1 ms, from 0 or later.
        angles: at each key [degrees], counterclockwise as seen.
        easing: how it goes from key to key, one of ``EASINGS``.
    """

    times: tuple[float, ...]
    angles: tuple[float, ...]
    easing: Easing = "ease"

    def __post_init__(self) -> None:
        angles = _checked_values("angles", self.angles, -MOST_DEGREES, MOST_DEGREES, " degrees")
        object.__setattr__(self, "angles", angles)
        object.__setattr__(self, "times", checked_times(self.times, len(angles), "angle"))
        checked_easing(self.easing)


@dataclass(frozen=True)
class Swing(_SameAtAnySize):
    """Turned to and fro about the rig point: angle = amplitude (sin(2 pi t / period + phase) - sin phase).

    Attributes:
        amplitude: [degrees], counterclockwise as seen.
        period: time of one swing forth and back [s], at least 0.01.
        phase: where in the swing it begins [degrees]; at -90 it begins at rest.
    """

    amplitude: float = 10.0
    period: float = 2.0
    phase: float = 0.0

    def __post_init__(self) -> None:
        bounded = within(self.amplitude, -MOST_DEGREES, MOST_DEGREES)
        require("amplitude", self.amplitude, bounded, f"-{MOST_DEGREES} to {MOST_DEGREES} degrees")
        _checked_period(self.period)
        checked_phase(self.phase)


@dataclass(frozen=True)
class Squash(_SameAtAnySize):
    """Stretched and squashed about the rig point by keyed factors; at rest before the first and after the last.

    The region is stretched by the ratio to the first key, so it never jumps at the start. Between the keys the
    logarithm is eased, so that stretching and squashing by one factor take the same course.

    Attributes:
        times: one per key [s], increasing by at least 1 ms, from 0 or later.
        factors: at each key; above 1 stretches, below squashes.
        angle: direction of the stretching [degrees]: 0 along x, 90 along y.
        keep_area: whether it narrows as much as it is stretched.
        easing: how it goes from key to key, one of ``EASINGS``.
    """

    times: tuple[float, ...]
    factors: tuple[float, ...]
    angle: float = 90.0
    keep_area: bool = True
    easing: Easing = "ease"

    def __post_init__(self) -> None:
        factors = _checked_values("factors", self.factors, 1 / MOST_STRETCH, MOST_STRETCH, "")
        object.__setattr__(self, "factors", factors)
        object.__setattr__(self, "times", checked_times(self.times, len(factors), "factor"))
        _checked_angle(self.angle)
        checked_easing(self.easing)


@dataclass(frozen=True)
class Pulse(_SameAtAnySize):
    """Stretched and squashed to and fro: factor = stretch^(sin(2 pi t / period + phase) - sin phase).

    Attributes:
        stretch: largest factor; 1.2 stretches by a fifth and squashes to 1 / 1.2.
        period: time from one stretch to the next [s], at least 0.01.
        phase: where in the pulse it begins [degrees]; at -90 it begins at rest.
        angle: direction of the stretching [degrees]: 0 along x, 90 along y.
        keep_area: whether it narrows as much as it is stretched.
    """

    stretch: float = 1.1
    period: float = 2.0
    phase: float = 0.0
    angle: float = 90.0
    keep_area: bool = True

    def __post_init__(self) -> None:
        bounded = within(self.stretch, 1 / MOST_STRETCH, MOST_STRETCH)
        require("stretch", self.stretch, bounded, f"{1 / MOST_STRETCH:g} to {MOST_STRETCH:g}")
        _checked_period(self.period)
        checked_phase(self.phase)
        _checked_angle(self.angle)
