"""Rig points: regions of a body that are held still or led along a motion (paper, Appendix, "rigging point")."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from ..checks import require_kind
from ..errors import InvalidInputError, counted, require
from ..fields import Field, Input, check_fields, described
from ..limits import MAX_BODIES
from ..points import Point, Scale, checked_pair, point_field, points_field, scaled_points
from .turns import (
    EasingField,
    Phase,
    Pulse,
    Rotation,
    Squash,
    Swing,
    checked_times,
    period_field,
    period_input,
    times_field,
)

__all__ = [
    "MOST_COMBINED",
    "BodyNumber",
    "Circle",
    "Combined",
    "KeyedPath",
    "MaskRegion",
    "Pinned",
    "Polygon",
    "RigMotion",
    "RigPoint",
    "RigRegion",
    "Wave",
]

_UNIT = 1e-15  # a direction that is this close to length 1 stays as it is, so that scaling it again changes nothing
MOST_COMBINED = 8


BodyNumber = Annotated[
    int | None,
    Field(
        "Body",
        "Number of the only body that it acts on, from 0. null: every body.",
        minimum=0,
        maximum=MAX_BODIES - 1,
        noun="a body's number,",
    ),
]


@described
@dataclass(frozen=True)
class Circle:
    """A disc about the rig point."""

    radius: Annotated[
        float,
        Field("Radius", "What is this near to the position is taken along.", "px", above=0),
        Input("What lies within this distance follows [px].", 0.5, 16384.0, step=1.0),
    ]

    def __post_init__(self) -> None:
        check_fields(self)

    def rescaled(self, scale: Scale) -> Circle:
        """The same disc over the picture at another size."""
        return Circle(self.radius * scale[2])


@described
@dataclass(frozen=True)
class Polygon:
    """The inside of a closed polygon."""

    points: Annotated[tuple[Point, ...], points_field("Corners", "Corners of a closed outline, in order.", least=3)]

    def __post_init__(self) -> None:
        check_fields(self)

    def rescaled(self, scale: Scale) -> Polygon:
        """The same polygon over the picture at another size."""
        return Polygon(scaled_points(self.points, scale))


@dataclass(frozen=True, eq=False)
class MaskRegion:
    """A painted region.

    Attributes:
        mask: true where vertices follow the rig point, bool, shape [h, w]; stretched over the illustration.
    """

    mask: NDArray[np.bool_]

    def __post_init__(self) -> None:
        mask = self.mask
        if not (isinstance(mask, np.ndarray) and mask.dtype == bool and not mask.flags.writeable):
            try:
                mask = np.array(mask, dtype=bool)
            except (TypeError, ValueError):
                raise InvalidInputError(f"mask must be an array of shape [h, w]. Got: {type(mask).__name__}") from None
        require("mask", f"shape {mask.shape}", mask.ndim == 2 and mask.size > 0, "an array of shape [h, w]")
        mask.setflags(write=False)
        object.__setattr__(self, "mask", mask)

    def rescaled(self, scale: Scale) -> MaskRegion:
        """Itself: a mask stretches over the picture whatever its size."""
        return self


@dataclass(frozen=True)
class Pinned:
    """Held where it was drawn."""

    def rescaled(self, scale: Scale) -> Pinned:
        """Itself."""
        return self


@described
@dataclass(frozen=True)
class KeyedPath:
    """Led through keyed points; at rest before the first and after the last.

    The region moves by the difference to the first key, so it never jumps at the start.

    The times increase by at least 1 ms.
    """

    times: Annotated[tuple[float, ...], times_field("When each point is reached, rising.")]
    points: Annotated[
        tuple[Point, ...],
        points_field(
            "Points",
            "Where the rig point is at each time. The part moves by the difference to the first.",
            least=2,
        ),
    ]
    easing: EasingField = "smooth"

    def __post_init__(self) -> None:
        check_fields(self)
        object.__setattr__(self, "times", checked_times(self.times, len(self.points), "point"))

    def rescaled(self, scale: Scale) -> KeyedPath:
        """The same path over the picture at another size."""
        return replace(self, points=scaled_points(self.points, scale))


def _checked_direction(name: str, direction: object) -> Point:
    x, y = checked_pair(name, direction)
    length = math.hypot(x, y)
    require(name, (x, y), 1e-9 <= length < math.inf, "a direction other than (0, 0)")
    return (x, y) if abs(length - 1) <= _UNIT else (x / length, y / length)


@described
@dataclass(frozen=True)
class Wave:
    """Swings: displacement = amplitude * sin(2 pi t / period) * direction (the paper's wavy rigging point).

    With a phase p it is amplitude * (sin(2 pi t / period + p) - sin p) * direction: it begins where it was drawn.

    """

    amplitude: Annotated[
        float,
        Field("Amplitude", "How far it swings to each side.", "px"),
        Input("How far it swings to either side [px].", -16384.0, 16384.0, step=1.0),
    ] = 20.0
    period: Annotated[
        float, period_field("Time of one swing forth and back."), period_input("Time of one swing forth and back [s].")
    ] = 2.0
    direction: Annotated[
        Point,
        Field("Direction", "Which way it swings first, x and y, of any length but 0.", check=_checked_direction),
    ] = (1.0, 0.0)
    phase: Phase = 0.0

    def __post_init__(self) -> None:
        check_fields(self)

    def rescaled(self, scale: Scale) -> Wave:
        """The same swing over the picture at another size."""
        x, y = self.direction[0] * scale[0], self.direction[1] * scale[1]
        return replace(self, amplitude=self.amplitude * math.hypot(x, y), direction=(x, y))


def _checked_motions(name: str, given: Any) -> tuple[RigMotion, ...]:
    require_kind(name, given, (tuple, list), "a list of motions")
    motions = tuple(given)
    require(name, counted(len(motions), "motion"), 1 <= len(motions) <= MOST_COMBINED, f"1 to {MOST_COMBINED}")
    if any(isinstance(motion, Combined) for motion in motions):
        raise InvalidInputError("motions must not be combined themselves. Got: a combined motion among them")
    for motion in motions:
        require_kind(name, motion, MOTIONS, _EXPECTED_MOTION)
    return motions


@described
@dataclass(frozen=True)
class Combined:
    """Several motions of one rig point at once.

    Ways add up. Turns and squashes act about the moving point, in the order in which they are given.

    None of them is combined itself.
    """

    motions: Annotated[
        tuple[Pinned | KeyedPath | Wave | Rotation | Swing | Squash | Pulse, ...],
        Field(
            "Motions",
            "Ways add up; turns and squashes act about the moving position, one after the other.",
            least=1,
            most=MOST_COMBINED,
            check=_checked_motions,
        ),
    ]

    def __post_init__(self) -> None:
        check_fields(self)

    def rescaled(self, scale: Scale) -> Combined:
        """The same motions over the picture at another size."""
        return Combined(tuple(motion.rescaled(scale) for motion in self.motions))


RigRegion = Circle | Polygon | MaskRegion
RigMotion = Pinned | KeyedPath | Wave | Rotation | Swing | Squash | Pulse | Combined

REGIONS = (Circle, Polygon, MaskRegion)
MOTIONS = (Pinned, KeyedPath, Wave, Rotation, Swing, Squash, Pulse, Combined)
_EXPECTED_MOTION = f"a motion: {', '.join(kind.__name__ for kind in MOTIONS)}"


def _checked_region(name: str, region: object) -> object:
    require_kind(name, region, REGIONS, "a region: Circle, Polygon or MaskRegion")
    return region


def _checked_motion(name: str, motion: object) -> object:
    if isinstance(motion, tuple | list):
        return Combined(tuple(motion))
    require_kind(name, motion, MOTIONS, _EXPECTED_MOTION)
    return motion


@described
@dataclass(frozen=True)
class RigPoint:
    """A point whose region is held or led.

    Several motions at once may be given as a tuple.

    Examples:
        >>> from physanimator.physics.rig import Circle, KeyedPath, RigPoint
        >>> hand = RigPoint((40, 20), Circle(12), KeyedPath(times=(0, 1), points=((40, 20), (60, 20))))
        >>> hand.motion.easing
        'smooth'
    """

    position: Annotated[Point, point_field("Position", "Where the rig point is drawn.")]
    region: Annotated[RigRegion, Field("Region", "Which part of the body it takes along.", check=_checked_region)] = (
        Circle(20.0)
    )
    motion: Annotated[RigMotion, Field("Motion", "How that part moves.", check=_checked_motion)] = Pinned()
    body: BodyNumber = None
    falloff: Annotated[
        float,
        Field(
            "Falloff",
            "How far beyond the region its pull fades out. 0: everything outside moves freely.",
            "px",
            minimum=0,
        ),
        Input("How far beyond the region its pull fades out [px]; 0 leaves all outside free.", high=16384.0, step=1.0),
    ] = 0.0

    def __post_init__(self) -> None:
        check_fields(self)

    def rescaled(self, scale: Scale) -> RigPoint:
        """The same rig point over the picture at another size."""
        (position,) = scaled_points((self.position,), scale)
        region, motion = self.region.rescaled(scale), self.motion.rescaled(scale)
        return replace(self, position=position, region=region, motion=motion, falloff=self.falloff * scale[2])
