"""Energy strokes: drawn polylines along which flow particles travel and push, repel or attract bodies.

Paper, Appendix "Details of Interactive Animation", with the mending that the forces act per mass and stop at
the radius.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Annotated, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ..errors import require
from ..fields import Field, Input, check_fields, described
from ..limits import LARGEST, MAX_PARTICLES_OF_STROKE
from ..points import Point, Scale, points_field, scaled_points
from .travel import MOST_KEYS, Key, Travel, checked_keys

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


@described
@dataclass(frozen=True)
class EnergyStroke:
    """A drawn stroke that emits flow particles.

    A particle leaves the first point at ``start`` and another every ``interval`` seconds until ``end``; each
    moves along the path at ``speed`` and vanishes at its last point. A path of one point, or a speed of 0, is a
    single resting particle that lives from ``start`` to ``end``. With ``repeat`` all of that comes again and again.

    With the distance d the effect goes, by ``falloff``, as 1 - d/radius (linear; for repel as d/radius), as
    (1 - (d/radius)^2)^2 (smooth), or stays (constant).

    Examples:
        >>> from physanimator.physics.forces import EnergyStroke
        >>> stroke = EnergyStroke("wind", path=((0, 30), (80, 30)), radius=40.0, strength=3.0)
        >>> stroke.kind, stroke.speed
        ('wind', 600.0)
    """

    kind: Annotated[
        StrokeKind,
        Field(
            "Kind",
            "wind blows along the path; repel pushes away, hardest at the radius; attract pulls closer, hardest at the"
            " centre (with a negative strength it pushes away, hardest at the centre).",
        ),
        Input("wind pushes along the path, repel pushes away from the particles, attract pulls to them."),
    ] = "wind"
    path: Annotated[
        tuple[Point, ...],
        points_field(
            "Path",
            "The points that particles travel along, in order, at least two for wind. One point is a particle at rest.",
            least=1,
        ),
    ] = ((0.0, 0.0), (1.0, 0.0))
    radius: Annotated[
        float,
        Field("Radius", "How far a particle reaches; nothing beyond is touched.", "px", above=0),
        Input("A particle acts up to this distance [px].", 1.0, 16384.0, step=10.0),
    ] = 200.0
    speed: Annotated[
        float,
        Field(
            "Speed",
            "How fast particles travel along the path. 0 is one particle at rest at the first point.",
            "px/s",
            minimum=0,
        ),
        Input(
            "How fast particles travel along the path [px/s]; 0 keeps one at its first point.",
            high=100_000.0,
            step=10.0,
        ),
    ] = 600.0
    strength: Annotated[
        float,
        Field(
            "Strength",
            "Acceleration at full effect. 1 is a breeze, 5 a storm. Negative turns the direction round.",
            "side/s^2",
        ),
        Input(
            "Acceleration at full effect [sides/s^2], a side being the picture's longest; 1 is a breeze, 10 a blow."
            " Negative reverses it.",
            -1000.0,
            1000.0,
            step=0.1,
        ),
    ] = 2.0
    start: Annotated[
        float,
        Field("Start", "When the first particle leaves.", "s", minimum=0),
        Input("When the first particle sets out [s].", high=3600.0, step=0.1),
    ] = 0.0
    end: Annotated[
        float | None,
        Field("End", "When particles stop leaving; after start. null: never.", "s", above=0),
        Input("When the last particle has set out [s]; 0 means never.", 0.0, 3600.0, step=0.1),
    ] = None
    interval: Annotated[
        float,
        Field(
            "Interval",
            "Time from one particle to the next: 0.1 sends ten a second, 2 lets single gusts pass.",
            "s",
            minimum=0.01,
        ),
        Input(
            "Time from one particle to the next [s]: 0.1 sends ten a second, a steady stream; 2 lets single gusts"
            " pass.",
            high=3600.0,
            step=0.1,
        ),
    ] = 0.5
    falloff: Annotated[
        Falloff,
        Field(
            "Falloff",
            "How the effect falls off up to the radius: linear (for repel it grows), smooth without a kink, constant"
            " not at all.",
        ),
        Input(
            "How the effect goes with the distance: linear falls evenly (repel: grows), smooth falls without a kink,"
            " constant acts alike up to the radius."
        ),
    ] = "linear"
    repeat: Annotated[
        float | None,
        Field("Repeat", "The time from start to end begins anew every so often. null: never.", "s", minimum=0.01),
        Input(
            "The time from start to end begins anew every so often [s]; 0 means never. Needs an end.",
            0.0,
            3600.0,
            step=0.1,
        ),
    ] = None
    strength_keys: Annotated[
        tuple[Key, ...],
        Field(
            "Strength along the path",
            "How the strength changes along the path; between two keys, evenly. Empty: not at all.",
            entry="strength_key",
            most=MOST_KEYS,
            check=checked_keys,
        ),
    ] = ()
    speed_keys: Annotated[
        tuple[Key, ...],
        Field(
            "Speed along the path",
            "How the speed changes along the path; between two keys, evenly. Empty: not at all.",
            entry="speed_key",
            most=MOST_KEYS,
            check=partial(checked_keys, positive=True),
        ),
    ] = ()

    def __post_init__(self) -> None:
        check_fields(self)
        if self.end is not None:
            expected = f"after start ({self.start} s) and at most {LARGEST} s"
            require("end", self.end, self.end > self.start, expected)
        if self.repeat is not None:
            window = math.inf if self.end is None else self.end - self.start
            expected = f"at least 0.01 s and the time from start to end ({window:g} s), and at most {LARGEST} s"
            expected = "left out where the stroke has no end" if self.end is None else expected
            require("repeat", self.repeat, self.repeat >= window * (1 - ROUNDING), expected)
        if self.kind == "wind":
            direction = self.polyline.length > 0
            require("path", self.path[:2], direction, "at least 2 different points, to give the wind a direction")
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
