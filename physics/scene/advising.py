"""What a scene probably does not mean: sentences to show as warnings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..errors import printable
from ..mesh import PixelBox, TriangleMesh, may_be_inverted, triangle_ids
from ..rig import Circle, MaskRegion, Polygon, RigPoint, coarseness_of, distances_of, leaders_of, vertices_of
from .scene import Scene

__all__ = ["absent_bodies", "advice", "inverted_masks", "loose_parts", "unused_rig_points"]

_NAMED = 3
_LISTED = 10
_LOOKED_AT = 128  # longest side at which it is seen what a mesh covers [px]


def advice(scene: Scene, *, masks: bool = True) -> list[str]:
    """A sentence for everything in a scene that an animator would want to know before simulating it.

    Args:
        scene: the scene.
        masks: whether to speak of its masks, too; false where that was done when they were read.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.rig import Circle, RigPoint
        >>> from physanimator.physics.scene import Body, Scene, advice
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> for line in advice(Scene((Body(mesh),), rig_points=(RigPoint((58, 58), Circle(1)),))):
        ...     print(line)
        rig_points[0] touches no body: its region of radius 1 px lies 10.6 px away; a radius of 12 px would reach it
    """
    return [
        *absent_bodies(scene),
        *(inverted_masks(scene) if masks else ()),
        *unused_rig_points(scene),
        *loose_parts(scene),
    ]


def absent_bodies(scene: Scene) -> list[str]:
    """A sentence about the bodies that the scene's document names and that are not there."""
    if not scene.absent:
        return []
    shown = [printable(name[:60]) for name in scene.absent[:_NAMED]]
    names = ", ".join(shown) + ("" if len(scene.absent) <= _NAMED else " and others")
    there = ", ".join(printable(body.name[:60]) for body in scene.bodies[:_LISTED] if body.name)
    one = len(scene.absent) == 1
    which, them = ("a body that is no moving part", "it") if one else ("bodies that are no moving parts", "them")
    more = "" if len(scene.bodies) <= _LISTED else " and others"
    return [f"the scene names {which}: {names}; what it says of {them} is left out. The parts are {there}{more}"]


def inverted_masks(scene: Scene) -> list[str]:
    """A sentence for each body that covers most of the picture up to its border, as an inverted mask does."""
    sentences = []
    for number, body in enumerate(scene.bodies):
        share = _share_if_inverted(body.mesh)
        if share:
            named = f" ({body.name})" if body.name else ""
            sentences.append(
                f"bodies[{number}]{named} covers {100 * share:.0f} % of the picture: if white is what shall stay still"
                " in its mask, invert it"
            )
    return sentences


def _share_if_inverted(mesh: TriangleMesh) -> float:
    """The share of the picture that a mesh covers, 0 if it looks like what is meant."""
    if mesh.areas.sum() < 0.5 * mesh.width * mesh.height:
        return 0.0
    scale = min(1.0, _LOOKED_AT / max(mesh.width, mesh.height))
    box = PixelBox(0, 0, max(1, round(mesh.width * scale)), max(1, round(mesh.height * scale)))
    sides = np.array([box.width / mesh.width, box.height / mesh.height])
    covered = (triangle_ids(mesh.vertices * sides, mesh.triangles, box) >= 0).astype(np.float32)
    return float(covered.mean()) if may_be_inverted(covered) else 0.0


def loose_parts(scene: Scene) -> list[str]:
    """A sentence for each body that is held somewhere but has separate parts that nothing holds.

    Such parts, locks of hair that an arm cuts off, say, drift away in the first wind. A body that nothing holds at all
    is taken to be meant so.
    """
    sentences = []
    for number, body in enumerate(scene.bodies):
        mesh = body.mesh
        led = leaders_of(scene.rig_points, mesh, body=number) >= 0
        parts = range(int(mesh.components.max()) + 1)
        loose = [mesh.vertices[mesh.components == part] for part in parts if not led[mesh.components == part].any()]
        if not loose or len(loose) == len(parts):
            continue
        tops = [part[part[:, 1].argmin()] for part in sorted(loose, key=len, reverse=True)]
        where = ", ".join(f"({x:.0f}, {y:.0f})" for x, y in tops[:_NAMED])
        named = f" ({body.name})" if body.name else ""
        counted = (
            "one separate part that no rig point holds: it"
            if len(loose) == 1
            else (f"{len(loose)} separate parts that no rig point holds: they")
        )
        more = "" if len(tops) <= _NAMED else " and so on"
        sentences.append(f"bodies[{number}]{named} has {counted} may drift away; pin at {where}{more} to hold on to it")
    return sentences


def unused_rig_points(scene: Scene) -> list[str]:
    """A sentence for each rig point whose region selects no vertex, to show as a warning."""
    sentences, coarse = [], coarseness_of([replace(each, falloff=1.0) for each in scene.rig_points])
    for index, rig_point in enumerate(scene.rig_points):
        bodies = scene.bodies if rig_point.body is None else (scene.bodies[rig_point.body],)
        if not any(vertices_of(rig_point, body.mesh).any() for body in bodies):
            touched = "no body" if rig_point.body is None else f"no vertex of body {rig_point.body}"
            where = _whereabouts(rig_point, [body.mesh for body in bodies], coarse)
            sentences.append(f"rig_points[{index}] touches {touched}: {where}")
    return sentences


def _whereabouts(rig_point: RigPoint, meshes: Sequence[TriangleMesh], coarse: int) -> str:
    region = rig_point.region
    if isinstance(region, MaskRegion) and not region.mask.any():
        return "nothing is painted in its mask"
    distance = min(float(distances_of(rig_point, mesh, coarse=coarse).min()) for mesh in meshes)
    if isinstance(region, Circle):
        away = f"its region of radius {region.radius:g} px lies {round(distance, 1):g} px away"
        return f"{away}; a radius of {math.ceil(region.radius + distance)} px would reach it"
    if isinstance(region, Polygon):
        return f"its polygon lies {round(distance, 1):g} px away from the nearest vertex"
    return f"its mask lies about {round(distance, 1):g} px away from the nearest vertex"
