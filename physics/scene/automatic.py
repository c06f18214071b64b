"""A good scene without drawing one: hold each body where it is attached and let gusts of wind pass."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..checks import within
from ..errors import require
from ..mesh import TriangleMesh, ways_from
from ..rig import RigPoint, vertices_of
from .attachment import pins
from .automatic_wind import breeze, gusts, length_of, unit_of
from .part_raster import PartRaster
from .roots import on_face
from .scene import Body, Scene
from .sides import Held

__all__ = ["USUAL_LENGTH", "automatic_scene", "swaying_by_size"]

USUAL_LENGTH = 0.3
"""Length of the body for which the presets' sway frequencies are meant [unit]."""

# How far the tip of a body usually is from what is held, as a share of its length at least: of a fringe of which only
# the ends hang free, these sway, as fast as what is so short does.
_USUALLY_FREE = 0.6

# Hair on a face rubs on it and is in its lee, and its short locks are rather springs than pendulums. As drawn pictures
# go, a fringe moves, but stays on its forehead: that of a bust and the long front lock of the example, in twice the
# usual wind, swing by a quarter of their length instead of six tenths.
_IN_LEE, _SPRINGY = 0.5, 1.25

# Far beyond what anybody draws, and such that what comes of them is within the bounds of strokes and of wind fields.
MOST_WIND, MOST_TURN = 100_000, 1_000_000


def automatic_scene(
    bodies: Sequence[Body],
    *,
    attach: Held | Sequence[Held] = "auto",
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
            See :func:`~.attachment.pins`.
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
    held = [pins(body, number, attach=sides[number]) for number, body in enumerate(bodies)]
    meshes = [body.mesh for body in bodies]
    if sway_by_size:
        unit = unit_of(meshes)
        bodies = [swaying_by_size(body, pinned, unit=unit) for body, pinned in zip(bodies, held, strict=True)]
    bodies = [
        _on_its_face(body, sways=sway_by_size) if side == "crown" else body
        for body, side in zip(bodies, sides, strict=True)
    ]
    rig_points = tuple(pin for pinned in held for pin in pinned)
    if turbulence is not None:
        wind = breeze(meshes, strength=wind_strength, angle=wind_angle, turbulence=turbulence)
        return Scene(tuple(bodies), (), rig_points, frame_rate=frame_rate, wind=wind)
    strokes = gusts(meshes, strength=wind_strength, angle=wind_angle) if wind_strength else ()
    return Scene(tuple(bodies), strokes, rig_points, frame_rate=frame_rate)


def swaying_by_size(body: Body, pinned: Sequence[RigPoint], *, unit: float) -> Body:
    """The body with its material's sway frequency f made that of its size, f sqrt(USUAL_LENGTH / length).

    Args:
        body: the body.
        pinned: what holds it.
        unit: of lengths [px], see ``unit_of``.
    """
    material = body.material
    if material.sway_frequency is None:
        return body
    length = min(length_of(body.mesh), _free_length(body.mesh, pinned) / _USUALLY_FREE) / unit
    frequency = material.sway_frequency * float(np.sqrt(USUAL_LENGTH / length))
    return replace(body, material=replace(material, sway_frequency=frequency))


def _on_its_face(body: Body, *, sways: bool) -> Body:
    """Hair that hangs from a crown as it answers the wind where it lies on the face."""
    share, material = on_face(PartRaster.of(body, np.ones(len(body.mesh.vertices), dtype=bool))), body.material
    frequency = material.sway_frequency
    if sways and frequency is not None:
        frequency *= _SPRINGY**share
    response = material.wind_response * _IN_LEE**share
    return replace(body, material=replace(material, sway_frequency=frequency, wind_response=response))


def _free_length(mesh: TriangleMesh, pinned: Sequence[RigPoint]) -> float:
    """How far the farthest tip of the body is from what is pinned, along the shape [px]."""
    if not pinned:
        return length_of(mesh)
    ways = ways_from(mesh, np.logical_or.reduce([vertices_of(point, mesh) for point in pinned]))
    return float(ways[np.isfinite(ways)].max(initial=0.0)) or length_of(mesh)
