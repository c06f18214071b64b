"""What a scene probably does not mean: sentences to show as warnings."""

from __future__ import annotations

from .rigging import leaders_of, unused_rig_points
from .scene import Scene

__all__ = ["advice", "loose_parts"]

_NAMED = 3


def advice(scene: Scene) -> list[str]:
    """A sentence for everything in a scene that an animator would want to know before simulating it."""
    return [*unused_rig_points(scene), *loose_parts(scene)]


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
