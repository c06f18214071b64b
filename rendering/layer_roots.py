"""Where layers of an artwork are held: the hints of their names, and what they touch that does not move."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from ..physics.material import preset
from ..physics.mesh import TriangleMesh
from ..physics.rig import Polygon
from ..physics.scene import Attachment, Body, Held, pins

if TYPE_CHECKING:
    from .artwork import LayerPlan

__all__ = ["attachment_of_layer", "resting_on_held"]

_HALF = 0.5


def resting_on_held(
    rests: Sequence[NDArray[np.bool_] | None],
    masks: Sequence[NDArray[np.floating]],
    meshes: Sequence[TriangleMesh],
    covers: Sequence[NDArray[np.bool_] | None],
    attachments: Sequence[Held],
) -> tuple[NDArray[np.bool_] | None, ...]:
    """Where parts held by an end rest on what is still, and on what is held of parts that move, as a ribbon on hair."""
    if "end" not in attachments:
        return (None,) * len(masks)
    held = np.zeros(masks[0].shape, dtype=np.uint8)
    for mesh, mask, cover, attach in zip(meshes, masks, covers, attachments, strict=True):
        if attach != "end":
            own = np.zeros_like(held)
            for pin in pins(Body(mesh, preset("hair"), cover=cover), 0, attach=attach):
                if isinstance(pin.region, Polygon):
                    cv2.fillPoly(own, [np.rint(pin.region.points).astype(np.int32)], 1)
            held |= own & (mask > _HALF).astype(np.uint8)
    touched = held > 0
    return tuple(
        (touched if rest is None else rest | touched) if attach == "end" else None
        for rest, attach in zip(rests, attachments, strict=True)
    )


def attachment_of_layer(plan: LayerPlan) -> Attachment:
    """Where a layer is held, by the hint of its name."""
    if plan.held == "top" and plan.preset == "hair":
        return "crown"
    if plan.held == "covered":
        return "covered" if plan.preset == "hair" else "end"
    hints: dict[str | None, Attachment] = {"top": "top", "waist": "top", "bottom": "bottom", "end": "end"}
    return hints.get(plan.held, "auto")
