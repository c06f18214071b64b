"""Motions of a rig point that turn and squash its region about the point, and how keyed values are eased."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Annotated, Literal, TypeVar, get_args

from ..checks import numbers_of
from ..errors import counted, require
from ..fields import Field, Input, check_fields, described
from ..limits import LARGEST, MAX_POINTS
from ..points import Scale

__all__ = [
    "EASINGS",
    "MOST_DEGREES",
    "MOST_STRETCH",
    "Easing",
    "EasingField",
    "Phase",
    "Pulse",
    "Rotation",
    "Squash",
    "Swing",
    "checked_times",
    "period_field",
    "period_input",
    "times_field",
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
    require("times", counted(len(checked), "time"), len(checked) == count, f"one per {what} ({count})")
    bounded = checked[0] >= 0 and all(t <= LARGEST for t in checked)
    require("times", checked[:8], bounded, f"from 0 to {LARGEST} s")
    rising = all(b - a > _SHORTEST * (1 - 1e-6) for a, b in pairwise(checked))
    require("times", checked[:8], rising, f"increasing by at least {_SHORTEST} s from key to key")
    return checked


def _checked_values(
    name: str, values: Sequence[float], *, low: float, high: float, unit: str = ""
) -> tuple[float, ...]:
    checked = numbers_of(name, values, "a list of numbers")
    require(name, counted(len(checked), "value"), len(checked) >= 2, "at least 2 values")
    require(name, checked[:8], all(low <= value <= high for value in checked), f"{low:g} to {high:g}{unit}")
    return checked


def _angle_field(title: str, about: str) -> Field:
    return Field(title, about, "degrees", minimum=-MOST_DEGREES, maximum=MOST_DEGREES)


def times_field(about: str) -> Field:
    """A field that holds the times of keys [s], to be checked by ``checked_times``."""
    return Field("Times", about, "s", entry="time", least=2, most=MAX_POINTS)


def period_field(about: str) -> Field:
    """A field that holds a period [s]."""
    return Field("Period", about, "s", minimum=0.01)


def period_input(tooltip: str) -> Input:
    """Its input."""
    return Input(tooltip, 0.05, 3600.0, step=0.1)


EasingField = Annotated[
    Easing,
    Field(
        "Easing",
        "smooth: flows through the keys; linear: at even speed; ease: stops at every key; hold: stays, then jumps.",
    ),
    Input("smooth flows through the keys, linear keeps an even speed, ease stops at each, hold jumps."),
]
Phase = Annotated[
    float,
    _angle_field("Phase", "Where in its course it begins, from where it was drawn; at -90 it begins at rest."),
    Input("Where in its course it begins [degrees]; -90 begins at rest.", -360.0, 360.0, step=5.0),
]
StretchAngle = Annotated[
    float,
    _angle_field("Angle", "Direction of the stretching: 0 along x, 90 along y."),
    Input("Direction of the stretching [degrees]: 0 along x, 90 along y.", -360.0, 360.0, step=5.0),
]
KeepArea = Annotated[
    bool,
    Field("Keep area", "Whether it narrows as much as it is stretched."),
    Input("Narrows as much as it is stretched, as soft things do."),
]


class _SameAtAnySize:
    def rescaled(self: T, scale: Scale) -> T:
        """Itself: angles and factors do not depend on the picture's size."""
        return self


@described
@dataclass(frozen=True)
class Rotation(_SameAtAnySize):
    """Turned about the rig point through keyed angles; at rest before the first and after the last.

    The region turns by the difference to the first key, so it never jumps at the start.

    The times increase by at least 1 ms; angles are counterclockwise as seen.
    """

    times: Annotated[tuple[float, ...], times_field("When each angle is reached, rising.")]
    angles: Annotated[
        tuple[float, ...],
        Field(
            "Angles",
            "How far it is turned at each time, counterclockwise. It turns by the difference to the first.",
            "degrees",
            entry="angle",
            least=2,
            most=MAX_POINTS,
            check=partial(_checked_values, low=-MOST_DEGREES, high=MOST_DEGREES, unit=" degrees"),
        ),
    ]
    easing: EasingField = "ease"

    def __post_init__(self) -> None:
        check_fields(self)
        object.__setattr__(self, "times", checked_times(self.times, len(self.angles), "angle"))


@described
@dataclass(frozen=True)
class Swing(_SameAtAnySize):
    """Turned to and fro about the rig point: angle = amplitude (sin(2 pi t / period + phase) - sin phase)."""

    amplitude: Annotated[
        float,
        _angle_field("Amplitude", "How far it turns to each side, counterclockwise first."),
        Input("How far it turns to either side [degrees].", -3600.0, 3600.0, step=1.0),
    ] = 10.0
    period: Annotated[
        float,
        period_field("Time of one swing forth and back."),
        period_input("Time of one swing forth and back [s]."),
    ] = 2.0
    phase: Phase = 0.0

    def __post_init__(self) -> None:
        check_fields(self)


@described
@dataclass(frozen=True)
class Squash(_SameAtAnySize):
    """Stretched and squashed about the rig point by keyed factors; at rest before the first and after the last.

    The region is stretched by the ratio to the first key, so it never jumps at the start. Between the keys the
    logarithm is eased, so that stretching and squashing by one factor take the same course.

    The times increase by at least 1 ms.
    """

    times: Annotated[tuple[float, ...], times_field("When each factor is reached, rising.")]
    factors: Annotated[
        tuple[float, ...],
        Field(
            "Factors",
            "Length at each time; above 1 stretches, below squashes. It is stretched by the ratio to the first.",
            entry="stretch",
            least=2,
            most=MAX_POINTS,
            check=partial(_checked_values, low=1 / MOST_STRETCH, high=MOST_STRETCH),
        ),
    ]
    angle: StretchAngle = 90.0
    keep_area: KeepArea = True
    easing: EasingField = "ease"

    def __post_init__(self) -> None:
        check_fields(self)
        object.__setattr__(self, "times", checked_times(self.times, len(self.factors), "factor"))


@described
@dataclass(frozen=True)
class Pulse(_SameAtAnySize):
    """Stretched and squashed to and fro: factor = stretch^(sin(2 pi t / period + phase) - sin phase)."""

    stretch: Annotated[
        float,
        Field(
            "Stretch",
            "Largest factor; 1.2 stretches by a fifth and squashes to 1 / 1.2.",
            minimum=1 / MOST_STRETCH,
            maximum=MOST_STRETCH,
        ),
        Input("Largest factor: 1.2 stretches by 20 %, squashes to 1/1.2.", step=0.05),
    ] = 1.1
    period: Annotated[
        float,
        period_field("Time from one stretch to the next."),
        period_input("Time from one stretch to the next [s]."),
    ] = 2.0
    phase: Phase = 0.0
    angle: StretchAngle = 90.0
    keep_area: KeepArea = True

    def __post_init__(self) -> None:
        check_fields(self)
