"""Energy strokes: drawn polylines along which flow particles travel and push, repel or attract bodies.

Paper, Appendix "Details of Interactive Animation", with the mending that the forces act per mass and stop at
the radius.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from .errors import require

__all__ = ["STROKE_KINDS", "EnergyStroke", "StrokeKind"]

StrokeKind = Literal["wind", "repel", "attract"]
STROKE_KINDS: tuple[StrokeKind, ...] = get_args(StrokeKind)


@dataclass(frozen=True)
class EnergyStroke:
    """A drawn stroke that emits flow particles.

    A particle leaves the first point at ``start`` and another every ``interval`` seconds until ``end``; each
    moves along the path at ``speed`` and vanishes at its last point. A path of one point, or a speed of 0, is a
    single resting particle that lives from ``start`` to ``end``.

    Attributes:
        kind: wind pushes along the particle's direction, repel pushes away from it, attract pulls towards it.
        path: points of the stroke [px], at least one (two for wind).
        radius: a particle acts up to this distance [px].
        speed: how fast particles travel along the path [px/s].
        strength: acceleration at full effect [side/s^2], a side being the picture's longest; negative reverses it.
        start: when the first particle leaves [s].
        end: when the stroke stops emitting [s]; None means never.
        interval: time between particles [s].
    """

    kind: StrokeKind = "wind"
    path: tuple[tuple[float, float], ...] = ((0.0, 0.0), (1.0, 0.0))
    radius: float = 200.0
    speed: float = 600.0
    strength: float = 2.0
    start: float = 0.0
    end: float | None = None
    interval: float = 0.5

    def __post_init__(self) -> None:
        path = tuple((float(x), float(y)) for x, y in self.path)
        object.__setattr__(self, "path", path)
        require("kind", self.kind, self.kind in STROKE_KINDS, f"one of {', '.join(STROKE_KINDS)}")
        shortest = 2 if self.kind == "wind" else 1
        require("path", len(path), len(path) >= shortest, f"at least {shortest} points for {self.kind}")
        require("path", path, bool(np.isfinite(path).all()), "finite pixel coordinates")
        require("radius", self.radius, 0 < self.radius < np.inf, "above 0 px")
        require("speed", self.speed, 0 <= self.speed < np.inf, "at least 0 px/s")
        require("strength", self.strength, bool(np.isfinite(self.strength)), "finite")
        require("start", self.start, 0 <= self.start < np.inf, "at least 0 s")
        require("interval", self.interval, 0.01 <= self.interval < np.inf, "at least 0.01 s")
        if self.end is not None:
            require("end", self.end, self.start < self.end < np.inf, f"after start ({self.start} s)")
