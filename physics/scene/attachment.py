"""Where a body is held: pinned regions, one or several for each connected part, found from its shape.

A part hangs from its top unless something says otherwise: it reaches a border of the picture through a narrow neck and
continues outside it (a plant's stalk), hair is blown aside, somebody names a side, or a layer's name says how such
things are worn. Outlines run around every part of a drawing, so the colours along the contour say nothing about where a
part is fixed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from ..errors import require
from ..rig import Pinned, Polygon, RigPoint
from .held_outline import hull_around, outlines_around
from .part_raster import PartRaster
from .roots import blown_from, covered_root, crown, end_in_contact, head
from .scene import Body, Scene
from .sides import ATTACHMENTS, Attachment, Held

__all__ = ["attachment_of", "held_where_said", "pins"]

BoolArray = NDArray[np.bool_]

_OUTWARD: dict[str, tuple[float, float]] = {
    "top": (0.0, -1.0),
    "bottom": (0.0, 1.0),
    "left": (-1.0, 0.0),
    "right": (1.0, 0.0),
}
# Share of a part's extent that is held: a ribbon hangs from its knot, a skirt from its waist.
_HELD_SHARE = {"hair": 0.22, "ribbon": 0.1, "cloth": 0.08, "leaf": 0.05, "jelly": 0.1}
_USUAL_SHARE = 0.1
# A neck on a border is narrow when the body's widest section is at least this many times wider.
_NECK_RATIO = 1.6
_FEWEST = 3  # vertices that hold a part

_FOUND: dict[str, Callable[[PartRaster], BoolArray]] = {
    "head": head,
    "crown": crown,
    "covered": covered_root,
    "end": end_in_contact,
}


def pins(body: Body, number: int, *, attach: Held = "auto") -> list[RigPoint]:
    """Pinned regions for each connected part of a body, where it is attached.

    Args:
        body: what to hold.
        number: the body's number in the scene.
        attach: side; "head" for hair on a head, "crown" for hair that hangs over a forehead, "covered" for what hangs
            behind a head, "end" for what is held where it touches what stands still; "auto" for each part's own; or
            "none" for nowhere.

    Raises:
        InvalidInputError: there is no such side.
    """
    require("attach", attach, attach in get_args(Held), f"one of {', '.join(ATTACHMENTS)}")
    if attach == "none":
        return []
    mesh = body.mesh
    points = []
    for component in range(int(mesh.components.max()) + 1):
        chosen = mesh.components == component
        for region in _held_regions(body, chosen, attach):
            centre = np.mean(region, axis=0)
            points.append(RigPoint((centre[0], centre[1]), Polygon(region), Pinned(), body=number))
    return points


def held_where_said(scene: Scene) -> Scene:
    """The scene with pins for the bodies that say where they are held (``Body.attach``) and have no rig point alone.

    They come first: of regions that overlap, the last one leads.
    """
    led = {point.body for point in scene.rig_points}
    free = [(number, body) for number, body in enumerate(scene.bodies) if number not in led]
    found = [pin for number, body in free for pin in pins(body, number, attach=body.attach)]
    return replace(scene, rig_points=(*found, *scene.rig_points)) if found else scene


def _held_regions(body: Body, chosen: BoolArray, attach: Attachment) -> list[tuple[tuple[float, float], ...]]:
    """Outlines [px] around what of one part is held; around never fewer than three vertices together."""
    mesh, part = body.mesh, body.mesh.vertices[chosen]
    if attach == "auto":
        attach = attachment_of(part, mesh.width, mesh.height)
        if attach == "top" and body.material.name == "hair":
            attach = blown_from(PartRaster.of(body, chosen)) or "head"
    if attach in _FOUND:
        held = np.zeros(len(chosen), dtype=bool)
        raster = PartRaster.of(body, chosen)
        held[chosen] = raster.at(_FOUND[attach](raster), part)
        if _FEWEST <= held.sum() < chosen.sum():
            return outlines_around(mesh, held)
        attach = "top"
    share = _HELD_SHARE.get(body.material.name, _USUAL_SHARE)
    depth = -(part @ np.array(_OUTWARD[attach]))
    depth -= depth.min()
    limit = max(share * float(depth.max()), float(np.sort(depth)[min(_FEWEST - 1, len(depth) - 1)]))
    return [hull_around(part[depth <= limit + 1e-9], extent=float(np.ptp(part, axis=0).max()))]


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
