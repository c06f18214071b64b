"""A good scene without drawing one: hold each body where it is attached and let gusts of wind pass.

Attachment is guessed from the shape alone: a body that reaches a border of the picture through a narrow neck
continues outside it and is held there (a plant's stalk), anything else hangs from its top. Outlines run around
every part of a drawing, so the colours along the contour say nothing about where a part is fixed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from ..checks import within
from ..errors import require
from ..forces import EnergyStroke, Wind
from ..material import Material
from ..mesh import UNITS_ACROSS, TriangleMesh
from ..rig import Pinned, Polygon, RigPoint
from .scene import Body, Scene

__all__ = [
    "ATTACHMENTS",
    "USUAL_LENGTH",
    "Attachment",
    "attachment_of",
    "automatic_scene",
    "breeze",
    "gusts",
    "pins",
    "swaying_by_size",
    "unit_of",
]

Attachment = Literal["auto", "top", "bottom", "left", "right"]
ATTACHMENTS: tuple[Attachment, ...] = get_args(Attachment)

USUAL_LENGTH = 0.3
"""Length of the body for which the presets' sway frequencies are meant [unit]."""

_OUTWARD: dict[str, tuple[float, float]] = {
    "top": (0.0, -1.0),
    "bottom": (0.0, 1.0),
    "left": (-1.0, 0.0),
    "right": (1.0, 0.0),
}
# Share of a part's extent that is held: a head of hair rests on the skull, a ribbon hangs from its knot.
_HELD_SHARE = {"hair": 0.22, "ribbon": 0.1, "cloth": 0.08, "leaf": 0.05, "jelly": 0.1}
_USUAL_SHARE = 0.1
_MARGIN = 0.01  # around what is held, as a share of the part, and at most 1 px
# A neck on a border is narrow when the body's widest section is at least this many times wider.
_NECK_RATIO = 1.6
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

# Far beyond what anybody draws, and such that what comes of them is within the bounds of strokes and of wind fields.
MOST_WIND, MOST_TURN = 100_000, 1_000_000


def automatic_scene(
    bodies: Sequence[Body],
    *,
    attach: Attachment | Sequence[Attachment] = "auto",
    frame_rate: float = 24.0,
    wind_strength: float = 1.0,
    wind_angle: float = 0.0,
    turbulence: float | None = None,
    sway_by_size: bool = True,
) -> Scene:
    """Bodies pinned where they are attached, under gentle gusts.

    Args:
        bodies: what moves.
        attach: side at which the bodies are held, one for all or one for each; "auto" decides for each connected part.
        frame_rate: frames a second.
        wind_strength: factor on the usual wind, -100,000 to 100,000; 0 is calm, 1 gentle, 3 a storm.
        wind_angle: where the wind blows to [degrees]: 0 to the right, 90 up, 180 to the left.
        turbulence: None for gusts that pass as energy strokes; a share from 0 to 1 for a wind field instead, which
            blows everywhere, comes and goes, and has eddies of that share.
        sway_by_size: take the materials' sway frequencies for a body of ``USUAL_LENGTH``, the largest body being of
            half as much again, and let smaller bodies sway faster, as pendulums do; otherwise they hold as they are.

    Raises:
        InvalidInputError: no body, or a number of sides that fits neither one nor all bodies.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.scene import Body, automatic_scene
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> scene = automatic_scene([Body(mesh)], attach="top", wind_strength=1.5)
        >>> len(scene.rig_points), len(scene.strokes)
        (1, 2)
    """
    require("bodies", len(bodies), len(bodies) > 0, "at least one")
    sides = [attach] * len(bodies) if isinstance(attach, str) else list(attach)
    require("attach", f"{len(sides)}", len(sides) == len(bodies), f"one side, or one for each of {len(bodies)} bodies")
    blows = within(wind_strength, -MOST_WIND, MOST_WIND)
    require("wind_strength", wind_strength, blows, f"-{MOST_WIND} to {MOST_WIND} (1 is gentle, 3 a storm)")
    require("wind_angle", wind_angle, within(wind_angle, -MOST_TURN, MOST_TURN), f"-{MOST_TURN} to {MOST_TURN} degrees")
    if sway_by_size:
        unit = unit_of([body.mesh for body in bodies])
        bodies = [replace(body, material=swaying_by_size(body.material, body.mesh, unit=unit)) for body in bodies]
    held = [pin for number, body in enumerate(bodies) for pin in pins(body, number, attach=sides[number])]
    meshes = [body.mesh for body in bodies]
    if turbulence is not None:
        wind = breeze(meshes, strength=wind_strength, angle=wind_angle, turbulence=turbulence)
        return Scene(tuple(bodies), (), tuple(held), frame_rate=frame_rate, wind=wind)
    strokes = gusts(meshes, strength=wind_strength, angle=wind_angle) if wind_strength else ()
    return Scene(tuple(bodies), strokes, tuple(held), frame_rate=frame_rate)


def unit_of(meshes: Sequence[TriangleMesh]) -> float:
    """The unit of these bodies [px], see ``UNITS_ACROSS``, whatever the size of the picture around them."""
    return max(_length(mesh) for mesh in meshes) / UNITS_ACROSS


def _length(mesh: TriangleMesh) -> float:
    """Diagonal of a body's bounding box [px]."""
    return float(np.hypot(*np.ptp(mesh.vertices, axis=0)))


def swaying_by_size(material: Material, mesh: TriangleMesh, *, unit: float) -> Material:
    """The material with its sway frequency f made that of the body's size, f sqrt(USUAL_LENGTH / length).

    Args:
        material: of the body.
        mesh: its shape.
        unit: of lengths [px], see ``unit_of``.
    """
    if material.sway_frequency is None:
        return material
    length = _length(mesh) / unit
    return replace(material, sway_frequency=material.sway_frequency * float(np.sqrt(USUAL_LENGTH / length)))


def pins(body: Body, number: int, *, attach: Attachment = "auto") -> list[RigPoint]:
    """One pinned region for each connected part of a body, at the side where it is attached.

    Args:
        body: what to hold.
        number: the body's number in the scene.
        attach: side, or "auto" for each part's own.

    Raises:
        InvalidInputError: there is no such side.
    """
    require("attach", attach, attach in ATTACHMENTS, f"one of {', '.join(ATTACHMENTS)}")
    share = _HELD_SHARE.get(body.material.name, _USUAL_SHARE)
    mesh = body.mesh
    points = []
    for component in range(int(mesh.components.max()) + 1):
        part = mesh.vertices[mesh.components == component]
        side = attachment_of(part, mesh.width, mesh.height) if attach == "auto" else attach
        region = _held_region(part, _OUTWARD[side], share)
        centre = np.mean(region, axis=0)
        points.append(RigPoint((centre[0], centre[1]), Polygon(region), Pinned(), body=number))
    return points


def attachment_of(part: NDArray[np.float64], width: int, height: int) -> Attachment:
    """The side at which a connected part is attached.

    Args:
        part: its vertices [px], shape [v, 2].
        width: of the picture [px].
        height: of the picture [px].
    """
    reach = {"bottom": part[:, 1] >= height, "left": part[:, 0] <= 0, "right": part[:, 0] >= width}
    for side, beyond in reach.items():
        across = 0 if side == "bottom" else 1
        widest = np.ptp(part[:, across])
        if beyond.any() and np.ptp(part[beyond, across]) * _NECK_RATIO <= widest:
            return side  # type: ignore[return-value]
    return "top"


def _held_region(
    part: NDArray[np.float64], outward: tuple[float, float], share: float
) -> tuple[tuple[float, float], ...]:
    """Convex outline [px] around the vertices nearest the attached end; never fewer than three vertices."""
    from scipy.spatial import ConvexHull

    depth = -(part @ np.array(outward))
    depth -= depth.min()
    limit = max(share * float(depth.max()), float(np.sort(depth)[min(2, len(depth) - 1)]))
    held = part[depth <= limit + 1e-9]
    # A margin keeps the vertices inside the polygon in spite of rounding, and gives collinear ones an area.
    margin = min(1.0, _MARGIN * float(np.ptp(part, axis=0).max()))
    corners = np.concatenate([held + margin * np.array(offset) for offset in ((-1, -1), (-1, 1), (1, -1), (1, 1))])
    return tuple((float(x), float(y)) for x, y in corners[ConvexHull(corners).vertices])


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
