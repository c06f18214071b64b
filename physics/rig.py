"""Rig points: regions of a body that are held still or led along a motion (paper, Appendix, "rigging point")."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .errors import require

__all__ = ["Circle", "KeyedPath", "MaskRegion", "Pinned", "Polygon", "RigMotion", "RigPoint", "RigRegion", "Wave"]

Point = tuple[float, float]


@dataclass(frozen=True)
class Circle:
    """A disc about the rig point.

    Attributes:
        radius: [px]; vertices within it follow the rig point.
    """

    radius: float

    def __post_init__(self) -> None:
        require("radius", self.radius, 0 < self.radius < np.inf, "above 0 px")


@dataclass(frozen=True)
class Polygon:
    """The inside of a closed polygon.

    Attributes:
        points: corners [px], at least three.
    """

    points: tuple[Point, ...]

    def __post_init__(self) -> None:
        points = tuple((float(x), float(y)) for x, y in self.points)
        object.__setattr__(self, "points", points)
        require("points", len(points), len(points) >= 3, "at least three points")
        require("points", points, bool(np.isfinite(points).all()), "finite pixel coordinates")


@dataclass(frozen=True, eq=False)
class MaskRegion:
    """A painted region.

    Attributes:
        mask: true where vertices follow the rig point, bool, shape [h, w] of the illustration.
    """

    mask: NDArray[np.bool_]

    def __post_init__(self) -> None:
        mask = np.array(self.mask, dtype=bool)
        require("mask", mask.shape, mask.ndim == 2 and mask.size > 0, "an array of shape [h, w]")
        mask.setflags(write=False)
        object.__setattr__(self, "mask", mask)


@dataclass(frozen=True)
class Pinned:
    """Held where it was drawn."""


@dataclass(frozen=True)
class KeyedPath:
    """Led through keyed points; smooth between them, at rest before the first and after the last.

    The region moves by the difference to the first key, so it never jumps at the start.

    Attributes:
        times: one per key [s], increasing, from 0 or later.
        points: where the rig point is at each key [px].
    """

    times: tuple[float, ...]
    points: tuple[Point, ...]

    def __post_init__(self) -> None:
        times = tuple(float(t) for t in self.times)
        points = tuple((float(x), float(y)) for x, y in self.points)
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "points", points)
        require("points", len(points), len(points) >= 2, "at least two keys")
        require("times", len(times), len(times) == len(points), f"one per key ({len(points)})")
        require("points", points, bool(np.isfinite(points).all()), "finite pixel coordinates")
        rising = bool(np.isfinite(times).all()) and times[0] >= 0 and bool((np.diff(times) > 0).all())
        require("times", times, rising, "increasing seconds from 0 or later")


@dataclass(frozen=True)
class Wave:
    """Swings: displacement = amplitude * sin(2 pi t / period) * direction (the paper's wavy rigging point).

    Attributes:
        amplitude: [px].
        period: time of one swing forth and back [s].
        direction: of the swing; scaled to unit length.
    """

    amplitude: float = 20.0
    period: float = 2.0
    direction: Point = (1.0, 0.0)

    def __post_init__(self) -> None:
        x, y = (float(value) for value in self.direction)
        length = float(np.hypot(x, y))
        require("amplitude", self.amplitude, bool(np.isfinite(self.amplitude)), "finite")
        require("period", self.period, 0 < self.period < np.inf, "above 0 s")
        require("direction", self.direction, 0 < length < np.inf, "a direction other than (0, 0)")
        object.__setattr__(self, "direction", (x / length, y / length))


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
        x, y = (float(value) for value in self.position)
        object.__setattr__(self, "position", (x, y))
        require("position", self.position, bool(np.isfinite((x, y)).all()), "finite pixel coordinates")
        if self.body is not None:
            require("body", self.body, self.body >= 0, "a body's number from 0")
