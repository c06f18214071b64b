"""Rig points: regions of a body that are held still or led along a motion (paper, Appendix, "rigging point")."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from .errors import require
from .limits import LARGEST
from .points import Point, Scale, checked_points, scaled_points

__all__ = ["Circle", "KeyedPath", "MaskRegion", "Pinned", "Polygon", "RigMotion", "RigPoint", "RigRegion", "Wave"]

_SHORTEST = 0.001  # [s] between two keys: no speed grows beyond what a float can bear
_UNIT = 1e-15  # a direction that is this close to length 1 stays as it is, so that scaling it again changes nothing


@dataclass(frozen=True)
class Circle:
    """A disc about the rig point.

    Attributes:
        radius: [px]; vertices within it follow the rig point.
    """

    radius: float

    def __post_init__(self) -> None:
        require("radius", self.radius, 0 < self.radius <= LARGEST, f"above 0 and at most {LARGEST} px")

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
        mask = np.array(self.mask, dtype=bool)
        require("mask", mask.shape, mask.ndim == 2 and mask.size > 0, "an array of shape [h, w]")
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
    """Led through keyed points; smooth between them, at rest before the first and after the last.

    The region moves by the difference to the first key, so it never jumps at the start.

    Attributes:
        times: one per key [s], increasing by at least 1 ms, from 0 or later.
        points: where the rig point is at each key [px].
    """

    times: tuple[float, ...]
    points: tuple[Point, ...]

    def __post_init__(self) -> None:
        times = tuple(float(t) for t in self.times)
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "points", checked_points("points", self.points, least=2))
        require("times", f"{len(times)} times", len(times) == len(self.points), f"one per point ({len(self.points)})")
        bounded = times[0] >= 0 and all(t <= LARGEST for t in times)
        require("times", times[:8], bounded, f"from 0 to {LARGEST} s")
        rising = all(b - a > _SHORTEST * (1 - 1e-6) for a, b in pairwise(times))
        require("times", times[:8], rising, f"increasing by at least {_SHORTEST} s from key to key")

    def rescaled(self, scale: Scale) -> KeyedPath:
        """The same path over the picture at another size."""
        return replace(self, points=scaled_points(self.points, scale))


@dataclass(frozen=True)
class Wave:
    """Swings: displacement = amplitude * sin(2 pi t / period) * direction (the paper's wavy rigging point).

    Attributes:
        amplitude: [px].
        period: time of one swing forth and back [s], at least 0.01.
        direction: of the swing; scaled to unit length.
    """

    amplitude: float = 20.0
    period: float = 2.0
    direction: Point = (1.0, 0.0)

    def __post_init__(self) -> None:
        x, y = (float(value) for value in self.direction)
        length = math.hypot(x, y)
        require("amplitude", self.amplitude, -LARGEST <= self.amplitude <= LARGEST, f"-{LARGEST} to {LARGEST} px")
        require("period", self.period, 0.01 <= self.period <= LARGEST, f"0.01 to {LARGEST} s")
        require("direction", (x, y), 1e-9 <= length < math.inf, "a direction other than (0, 0)")
        if abs(length - 1) > _UNIT:
            x, y = x / length, y / length
        object.__setattr__(self, "direction", (x, y))

    def rescaled(self, scale: Scale) -> Wave:
        """The same swing over the picture at another size."""
        x, y = self.direction[0] * scale[0], self.direction[1] * scale[1]
        return replace(self, amplitude=self.amplitude * math.hypot(x, y), direction=(x, y))


RigRegion = Circle | Polygon | MaskRegion
RigMotion = Pinned | KeyedPath | Wave


@dataclass(frozen=True)
class RigPoint:
    """A point whose region is held or led.

    Attributes:
        position: [px].
        region: which vertices follow.
        motion: how they move.
        body: number of the body that it acts on; None means every body.
    """

    position: Point
    region: RigRegion = Circle(20.0)
    motion: RigMotion = Pinned()
    body: int | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", checked_points("position", (self.position,), least=1)[0])
        if self.body is not None:
            require("body", self.body, self.body >= 0, "a body's number from 0")

    def rescaled(self, scale: Scale) -> RigPoint:
        """The same rig point over the picture at another size."""
        (position,) = scaled_points((self.position,), scale)
        region, motion = self.region.rescaled(scale), self.motion.rescaled(scale)
        return replace(self, position=position, region=region, motion=motion)
