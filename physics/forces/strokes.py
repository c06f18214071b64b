"""Energy strokes: drawn polylines along which flow particles travel and push, repel or attract bodies.

Paper, Appendix "Details of Interactive Animation", with the mending that the forces act per mass and stop at
the radius.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ..checks import within
from ..errors import require
from ..limits import LARGEST, MAX_PARTICLES_OF_STROKE
from ..points import Point, Scale, checked_points, scaled_points
from .travel import Key, Travel, checked_keys

__all__ = ["FALLOFFS", "ROUNDING", "STROKE_KINDS", "EnergyStroke", "Falloff", "Polyline", "StrokeKind"]

StrokeKind = Literal["wind", "repel", "attract"]
STROKE_KINDS: tuple[StrokeKind, ...] = get_args(StrokeKind)

Falloff = Literal["linear", "smooth", "constant"]
FALLOFFS: tuple[Falloff, ...] = get_args(Falloff)

ROUNDING = 1e-9
"""Slack in counting intervals [intervals]: 0.3 s / 0.1 s must give three, whatever float64 makes of it."""

_REPEATED = 1e-9  # [px]: nearer neighbours are one point, drawn twice


@dataclass(frozen=True, eq=False)
class Polyline:
    """A path by arc length, without its repeated points.

    Attributes:
        points: corners [px], shape [k, 2], no two neighbours alike.
        arc_lengths: distance of each corner from the first along the path [px], shape [k].
        directions: unit direction of each segment, shape [k - 1, 2].
    """

    points: NDArray[np.float64]
    arc_lengths: NDArray[np.float64]
    directions: NDArray[np.float64]

    @property
    def length(self) -> float:
        """Length of the whole path [px]."""
        return float(self.arc_lengths[-1])


@dataclass(frozen=True)
class EnergyStroke:
    """A drawn stroke that emits flow particles.

    A particle leaves the first point at ``start`` and another every ``interval`` seconds until ``end``; each
    moves along the path at ``speed`` and vanishes at its last point. A path of one point, or a speed of 0, is a
    single resting particle that lives from ``start`` to ``end``. With ``repeat`` all of that comes again and again.

    Attributes:
        kind: wind pushes along the particle's direction, repel pushes away from it, attract pulls towards it.
        path: points of the stroke [px], at least one (two different ones for wind).
        radius: a particle acts up to this distance [px].
        speed: how fast particles travel along the path [px/s].
        strength: acceleration at full effect [side/s^2], a side being the picture's longest; negative reverses it.
        start: when the first particle leaves [s].
        end: when the stroke stops emitting [s]; None means never.
        interval: time from one particle to the next [s]; the rate of emission is its inverse.
        falloff: how the effect goes with the distance d: linear as 1 - d/radius (repel: as d/radius), smooth as
            (1 - (d/radius)^2)^2 without a kink, constant up to the radius.
        repeat: the time from ``start`` to ``end`` begins anew every so many seconds [s]; None means once.
        strength_keys: factors on the strength along the path, as pairs (share of its length from 0 to 1, factor).
        speed_keys: factors above 0 on the speed along the path, in the same form.
    """

    kind: StrokeKind = "wind"
    path: tuple[Point, ...] = ((0.0, 0.0), (1.0, 0.0))
    radius: float = 200.0
    speed: float = 600.0
    strength: float = 2.0
    start: float = 0.0
    end: float | None = None
    interval: float = 0.5
    falloff: Falloff = "linear"
    repeat: float | None = None
    strength_keys: tuple[Key, ...] = ()
    speed_keys: tuple[Key, ...] = ()

    def __post_init__(self) -> None:
        known = isinstance(self.kind, str) and self.kind in STROKE_KINDS
        require("kind", self.kind, known, f"one of {', '.join(STROKE_KINDS)}")
        path = checked_points("path", self.path, least=1)
        object.__setattr__(self, "path", path)
        require("radius", self.radius, within(self.radius, 0, LARGEST, above=True), f"above 0 and at most {LARGEST} px")
        require("speed", self.speed, within(self.speed, 0, LARGEST), f"0 to {LARGEST} px/s")
        bounded = within(self.strength, -LARGEST, LARGEST)
        require("strength", self.strength, bounded, f"-{LARGEST} to {LARGEST} side/s^2")
        require("start", self.start, within(self.start, 0, LARGEST), f"0 to {LARGEST} s")
        require("interval", self.interval, within(self.interval, 0.01, LARGEST), f"0.01 to {LARGEST} s")
        if self.end is not None:
            after_start = within(self.end, self.start, LARGEST, above=True)
            require("end", self.end, after_start, f"after start ({self.start} s) and at most {LARGEST} s")
        known = isinstance(self.falloff, str) and self.falloff in FALLOFFS
        require("falloff", self.falloff, known, f"one of {', '.join(FALLOFFS)}")
        if self.repeat is not None:
            window = math.inf if self.end is None else self.end - self.start
            long_enough = within(self.repeat, max(window * (1 - ROUNDING), 0.01), LARGEST)
            expected = f"at least 0.01 s and the time from start to end ({window:g} s), and at most {LARGEST} s"
            expected = "left out where the stroke has no end" if self.end is None else expected
            require("repeat", self.repeat, long_enough, expected)
        object.__setattr__(self, "strength_keys", checked_keys("strength_keys", self.strength_keys))
        object.__setattr__(self, "speed_keys", checked_keys("speed_keys", self.speed_keys, positive=True))
        if self.kind == "wind":
            direction = self.polyline.length > 0
            require("path", path[:2], direction, "at least 2 different points, to give the wind a direction")
        self._require_few_particles()

    @cached_property
    def polyline(self) -> Polyline:
        """The path by arc length."""
        points = np.array(self.path)
        moves = np.hypot(*np.diff(points, axis=0).T) > _REPEATED
        points = points[np.concatenate([[True], moves])]
        steps = np.diff(points, axis=0)
        lengths = np.hypot(*steps.T)
        directions = steps / lengths[:, None]
        line = Polyline(points, np.concatenate([[0.0], np.cumsum(lengths)]), directions)
        for array in (line.points, line.arc_lengths, line.directions):
            array.setflags(write=False)
        return line

    @property
    def effect_number(self) -> int:
        """Kind and falloff as one number: index into ``STROKE_KINDS`` plus their count times that into ``FALLOFFS``."""
        return STROKE_KINDS.index(self.kind) + len(STROKE_KINDS) * FALLOFFS.index(self.falloff)

    @property
    def rests(self) -> bool:
        """Whether the stroke is a single resting particle."""
        return self.speed == 0 or self.polyline.length == 0

    @cached_property
    def travel(self) -> Travel:
        """How a particle moves along the path by its age."""
        return Travel(self.polyline.length, self.speed, self.speed_keys)

    @property
    def emissions(self) -> float:
        """How many particles leave from ``start`` to ``end``; infinite without an end."""
        if self.end is None:
            return math.inf
        return math.ceil((self.end - self.start) / self.interval - ROUNDING)

    @property
    def most_particles(self) -> float:
        """The largest number of particles that are alive at once; infinite for a crawl without an end."""
        if self.rests:
            return 1
        lifetime = self.travel.lifetime
        if self.repeat is None or lifetime == math.inf:
            alive = lifetime / self.interval
            return min(self.emissions, math.ceil(alive - ROUNDING) if alive < math.inf else math.inf)
        rounds, rest = divmod(lifetime, self.repeat)
        return self.emissions * rounds + min(self.emissions, math.ceil(rest / self.interval) + 1)

    def rescaled(self, scale: Scale) -> EnergyStroke:
        """The same stroke over the picture at another size."""
        path = scaled_points(self.path, scale)
        return replace(self, path=path, radius=self.radius * scale[2], speed=self.speed * scale[2])

    def _require_few_particles(self) -> None:
        most = self.most_particles
        require(
            "interval",
            f"{self.interval} s, with {most:.6g} particles under way at once",
            most <= MAX_PARTICLES_OF_STROKE,
            f"so long, or the speed ({self.speed} px/s) so high, that at most {MAX_PARTICLES_OF_STROKE} particles"
            f" are under way at once on a path of {self.polyline.length:.0f} px",
        )
