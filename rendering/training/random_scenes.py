"""Random scenes for clips of our own simulator: materials, wind and strokes, all from one seed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...physics.forces import EnergyStroke
from ...physics.material import PRESETS
from ...physics.scene import Scene
from ..options import AutomaticWind

__all__ = ["RandomMotion", "random_motion", "with_strokes"]

_MOST_STROKES = 2


@dataclass(frozen=True)
class RandomMotion:
    """What moves a clip.

    Attributes:
        wind: of the automatic scene.
        presets: one material for each part of a flat picture.
        strokes: how many are drawn.
    """

    wind: AutomaticWind
    presets: tuple[str, ...]
    strokes: int


def random_motion(chance: np.random.Generator, parts: int) -> RandomMotion:
    """Wind from a breeze to a storm, to the left or the right, steady or in gusts; any material; up to two strokes.

    Args:
        chance: of the clip.
        parts: how many parts a flat picture has; 0 for layered artwork, whose names say what they are made of.
    """
    side = chance.choice([0.0, 180.0])
    wind = AutomaticWind(
        strength=float(np.exp(chance.uniform(np.log(0.7), np.log(3.5)))),
        angle=float(side + chance.uniform(-30, 30)),
        turbulence=float(chance.uniform(0.1, 0.6)) if chance.random() < 0.5 else None,
    )
    presets = tuple(str(each) for each in chance.choice(sorted(PRESETS), parts))
    return RandomMotion(wind, presets, int(chance.integers(0, _MOST_STROKES + 1)))


def with_strokes(scene: Scene, chance: np.random.Generator, count: int, size: tuple[int, int]) -> Scene:
    """A scene with strokes of wind across some of its parts.

    Args:
        scene: with bodies.
        chance: of the clip.
        count: how many.
        size: width and height of the picture [px].
    """
    strokes = tuple(_stroke(chance, scene, size) for _ in range(count))
    return replace(scene, strokes=(*scene.strokes, *strokes)) if strokes else scene


def _stroke(chance: np.random.Generator, scene: Scene, size: tuple[int, int]) -> EnergyStroke:
    """Two points on either side of a vertex of a part, so that the stroke passes over it."""
    body = scene.bodies[int(chance.integers(len(scene.bodies)))]
    middle = body.mesh.vertices[int(chance.integers(len(body.mesh.vertices)))]
    longest = max(size)
    angle, reach = chance.uniform(0, 2 * np.pi), chance.uniform(0.15, 0.4) * longest
    along = reach * np.array([np.cos(angle), np.sin(angle)])
    path: Sequence[tuple[float, float]] = [_point(middle - along), _point(middle + along)]
    return EnergyStroke(
        "wind",
        path=tuple(path),
        radius=float(chance.uniform(0.08, 0.25) * longest),
        speed=float(chance.uniform(0.4, 1.5) * longest),
        strength=float(chance.uniform(1.0, 6.0)),
        interval=float(chance.uniform(0.2, 1.2)),
    )


def _point(place: np.ndarray) -> tuple[float, float]:
    return float(place[0]), float(place[1])
