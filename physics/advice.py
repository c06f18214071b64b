"""What a scene probably does not mean: sentences to show as warnings."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .motion import Motion
from .rigging import leaders_of, unused_rig_points
from .scene import Scene

__all__ = ["advice", "loose_parts", "mask_advice", "stillness"]

_NAMED = 3
# What nobody sees: frames drawn with less differ by resampling alone [px].
_UNSEEN = 0.25
# Smaller parts than this are rather a slip of the brush than something that bends [px].
_TINY = 64
_MOSTLY = 0.9


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


def stillness(motion: Motion) -> list[str]:
    """A sentence where a motion of several frames shows nothing that anybody could see."""
    moved = motion.positions - motion.positions[:1]
    farthest = float(np.hypot(moved[..., 0], moved[..., 1]).max(initial=0.0))
    if len(motion) < 2 or farthest >= _UNSEEN:
        return []
    what = f"nothing moves by more than {farthest:.2f} px" if farthest >= 0.01 else "nothing moves at all"
    return [
        f"{what} in {len(motion)} frames: is everything held, do strokes and wind"
        " reach the bodies, and are they strong and early enough?"
    ]


def mask_advice(mask: ArrayLike) -> list[str]:
    """Sentences about a mask that probably shows something else than the part that shall move.

    Args:
        mask: coverage 0..1 or bool, shape [h, w].
    """
    covered = np.asarray(mask) > 0.5
    pixels, share = int(np.count_nonzero(covered)), float(covered.mean()) if covered.size else 0.0
    if 0 < pixels < _TINY:
        return [f"the mask covers {pixels} px only: is it the whole part that shall move?"]
    if share > _MOSTLY:
        return [f"the mask covers {100 * share:.0f} % of the picture: is it inverted? White is what moves."]
    return []
