"""Rig points: regions of a body that are held still or led along a motion (paper, Appendix, "rigging point")."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..checks import is_whole, require_kind, within
from ..errors import InvalidInputError, require
from ..limits import LARGEST, MAX_BODIES
from ..points import Point, Scale, checked_pair, checked_points, scaled_points
from .turns import Easing, Pulse, Rotation, Squash, Swing, checked_easing, checked_phase, checked_times

__all__ = [
    "MOST_COMBINED",
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


@dataclass(frozen=True)
class Circle:
    """A disc about the rig point.

    Attributes:
        radius: [px]; vertices within it follow the rig point.
    """

    radius: float

    def __post_init__(self) -> None:
        require("radius", self.radius, within(self.radius, 0, LARGEST, above=True), f"above 0 and at most {LARGEST} px")

    def rescaled(self, scale: Scale) -> Circle:
        """The same disc over the picture at another size."""
        return Circle(self.radius * scale[2])


@dataclass(frozen=True)
class Polygon:
    """The inside of a closed polygon.

    Attributes:
        points: corners [px], at least three.
    """

    points: tuple[Point, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", checked_points("points", self.points, least=3))

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


@dataclass(frozen=True)
class KeyedPath:
    """Led through keyed points; at rest before the first and after the last.

    The region moves by the difference to the first key, so it never jumps at the start.

    Attributes:
        times: one per key [s], increasing by at least 1 ms, from 0 or later.
        points: where the rig point is at each key [px].
        easing: how it goes from key to key, one of ``turns.EASINGS``.
    """

    times: tuple[float, ...]
    points: tuple[Point, ...]
    easing: Easing = "smooth"

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", checked_points("points", self.points, least=2))
        object.__setattr__(self, "times", checked_times(self.times, len(self.points), "point"))
        checked_easing(self.easing)

    def rescaled(self, scale: Scale) -> KeyedPath:
        """The same path over the picture at another size."""
        return replace(self, points=scaled_points(self.points, scale))


@dataclass(frozen=True)
class Wave:
    """Swings: displacement = amplitude * sin(2 pi t / period) * direction (the paper's wavy rigging point).

    With a phase p it is amplitude * (sin(2 pi t / period + p) - sin p) * direction: it begins where it was drawn.

    Attributes:
        amplitude: [px].
        period: time of one swing forth and back [s], at least 0.01.
        direction: of the swing; scaled to unit length.
        phase: where in the swing it begins [degrees]; at -90 it begins at rest.
    """

    amplitude: float = 20.0
    period: float = 2.0
    direction: Point = (1.0, 0.0)
    phase: float = 0.0

    def __post_init__(self) -> None:
        x, y = checked_pair("direction", self.direction)
        length = math.hypot(x, y)
        bounded = within(self.amplitude, -LARGEST, LARGEST)
        require("amplitude", self.amplitude, bounded, f"-{LARGEST} to {LARGEST} px")
        require("period", self.period, within(self.period, 0.01, LARGEST), f"0.01 to {LARGEST} s")
        require("direction", (x, y), 1e-9 <= length < math.inf, "a direction other than (0, 0)")
        if abs(length - 1) > _UNIT:
            x, y = x / length, y / length
        object.__setattr__(self, "direction", (x, y))
        checked_phase(self.phase)

    def rescaled(self, scale: Scale) -> Wave:
        """The same swing over the picture at another size."""
        x, y = self.direction[0] * scale[0], self.direction[1] * scale[1]
        return replace(self, amplitude=self.amplitude * math.hypot(x, y), direction=(x, y))


@dataclass(frozen=True)
class Combined:
    """Several motions of one rig point at once.

    Ways add up. Turns and squashes act about the moving point, in the order in which they are given.

    Attributes:
        motions: at least one, none of them combined itself.
    """

    motions: tuple[Pinned | KeyedPath | Wave | Rotation | Swing | Squash | Pulse, ...]

    def __post_init__(self) -> None:
        require_kind("motions", self.motions, (tuple, list), "a list of motions")
        motions = tuple(self.motions)
        require("motions", f"{len(motions)} motions", 1 <= len(motions) <= MOST_COMBINED, f"1 to {MOST_COMBINED}")
        if any(isinstance(motion, Combined) for motion in motions):
            raise InvalidInputError("motions must not be combined themselves. Got: a combined motion among them")
        for motion in motions:
            require_kind("motions", motion, MOTIONS, _EXPECTED_MOTION)
        object.__setattr__(self, "motions", motions)

    def rescaled(self, scale: Scale) -> Combined:
        """The same motions over the picture at another size."""
        return Combined(tuple(motion.rescaled(scale) for motion in self.motions))


RigRegion = Circle | Polygon | MaskRegion
RigMotion = Pinned | KeyedPath | Wave | Rotation | Swing | Squash | Pulse | Combined

REGIONS = (Circle, Polygon, MaskRegion)
MOTIONS = (Pinned, KeyedPath, Wave, Rotation, Swing, Squash, Pulse, Combined)
_EXPECTED_MOTION = f"a motion: {', '.join(kind.__name__ for kind in MOTIONS)}"


@dataclass(frozen=True)
class RigPoint:
    """A point whose region is held or led.

    Attributes:
        position: [px].
        region: which vertices follow.
        motion: how they move; several motions at once may be given as a tuple.
        body: number of the body that it acts on; None means every body.
        falloff: how far beyond the region the pull fades out [px]; 0 leaves everything outside free.

    Examples:
        >>> from physanimator.physics.rig import Circle, KeyedPath, RigPoint
        >>> hand = RigPoint((40, 20), Circle(12), KeyedPath(times=(0, 1), points=((40, 20), (60, 20))))
        >>> hand.motion.easing
        'smooth'
    """

    position: Point
    region: RigRegion = Circle(20.0)
    motion: RigMotion = Pinned()
    body: int | None = None
    falloff: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", checked_points("position", (self.position,), least=1)[0])
        if isinstance(self.motion, tuple | list):
            object.__setattr__(self, "motion", Combined(tuple(self.motion)))
        require_kind("region", self.region, REGIONS, "a region: Circle, Polygon or MaskRegion")
        require_kind("motion", self.motion, MOTIONS, _EXPECTED_MOTION)
        if self.body is not None:
            most = MAX_BODIES - 1
            require("body", self.body, is_whole(self.body, 0, most), f"a body's number, 0 to {most}")
            object.__setattr__(self, "body", int(self.body))
        require("falloff", self.falloff, within(self.falloff, 0, LARGEST), f"0 to {LARGEST} px")

    def rescaled(self, scale: Scale) -> RigPoint:
        """The same rig point over the picture at another size."""
        (position,) = scaled_points((self.position,), scale)
        region, motion = self.region.rescaled(scale), self.motion.rescaled(scale)
        return replace(self, position=position, region=region, motion=motion, falloff=self.falloff * scale[2])
