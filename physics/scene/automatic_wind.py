"""The wind of the automatic scene: gusts that pass over all bodies, or a field that blows everywhere."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..forces import EnergyStroke, Wind
from ..mesh import UNITS_ACROSS, TriangleMesh

__all__ = ["breeze", "gusts", "length_of", "unit_of"]

# The wind field: usual strength [unit/s^2], and an eddy as a share of all bodies' extent and at least so many units.
_BREEZE = 1.0
_EDDY, _SMALLEST_EDDY = 0.4, 0.05
# Of gusts, whose radius sets how fast they pass: in units, and as a share of all bodies' length along the wind, so that
# the last of a long row is reached after a second.
_NARROWEST_GUST, _SHORTEST_GUST = 0.12, 1 / 3


class _Gusts(NamedTuple):
    """Gusts that follow each other: strength as a share, interval and start [s], bend of their way [radius]."""

    strength: float
    interval: float
    start: float
    bend: float


# Two kinds that together repeat only after 305.51 s, the least common multiple of their intervals. Measured on the
# example's hair and a sample's: half the intervals sway it by 40 % more, twice as long ones by 15 % less; half or twice
# the bends, for which no better reason is known, move it by 7 to 22 % of its sway.
_GUSTS = (_Gusts(1.0, 1.37, 0.0, 0.12), _Gusts(0.6, 2.23, 0.6, -0.18))


def unit_of(meshes: Sequence[TriangleMesh]) -> float:
    """The unit of these bodies [px], see ``UNITS_ACROSS``, whatever the size of the picture around them."""
    return max(length_of(mesh) for mesh in meshes) / UNITS_ACROSS


def length_of(mesh: TriangleMesh) -> float:
    """Diagonal of a body's bounding box [px]."""
    return float(np.hypot(*np.ptp(mesh.vertices, axis=0)))


def gusts(meshes: Sequence[TriangleMesh], *, strength: float = 1.0, angle: float = 0.0) -> tuple[EnergyStroke, ...]:
    """Two trains of wind particles over all bodies, of incommensurable rhythm, so that the wind never seems to repeat.

    Args:
        meshes: the bodies.
        strength: factor on the usual wind.
        angle: where the wind blows to [degrees]: 0 to the right, 90 up.
    """
    vertices, unit = np.concatenate([mesh.vertices for mesh in meshes]), unit_of(meshes)
    radians = np.deg2rad(angle)
    along = np.array([np.cos(radians), -np.sin(radians)])
    across = np.array([-along[1], along[0]])
    first, last = (vertices @ along).min(), (vertices @ along).max()
    low, high = (vertices @ across).min(), (vertices @ across).max()
    radius = max(high - low, _NARROWEST_GUST * unit, _SHORTEST_GUST * (last - first))
    speed = 2 * radius / 0.75
    usual, digits = strength * unit / meshes[0].longest_side, max(1, 4 - int(np.log10(unit)))
    strokes = []
    for waves, (force, interval, start, bend) in enumerate(_GUSTS, start=1):
        distance = np.linspace(first - 0.85 * radius, last + radius, 17)
        lift = bend * radius * np.sin(np.linspace(0, 2 * np.pi * waves, 17))
        path = distance[:, None] * along + ((low + high) / 2 + lift)[:, None] * across
        points = tuple((round(float(x), digits), round(float(y), digits)) for x, y in path)
        strokes.append(EnergyStroke("wind", points, radius, speed, force * usual, start, None, interval))
    return tuple(strokes)


def breeze(
    meshes: Sequence[TriangleMesh], *, strength: float = 1.0, angle: float = 0.0, turbulence: float = 0.3
) -> Wind:
    """A wind field that comes and goes, with eddies as large as suits the bodies, laid from the corner of their box.

    Args:
        meshes: the bodies.
        strength: factor on the usual wind.
        angle: where the wind blows to [degrees]: 0 to the right, 90 up.
        turbulence: strength of the eddies as a share of the wind's.
    """
    vertices, unit = np.concatenate([mesh.vertices for mesh in meshes]), unit_of(meshes)
    size = max(_EDDY * float(np.ptp(vertices, axis=0).max()), _SMALLEST_EDDY * unit)
    corner = vertices.min(axis=0).tolist()
    return Wind(
        _BREEZE * strength * unit / meshes[0].longest_side,
        angle,
        turbulence=turbulence,
        turbulence_size=size,
        origin=(corner[0], corner[1]),
    )
