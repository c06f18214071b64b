"""Layers that somebody chose as bodies, beside those that are bodies already."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..physics.material import preset
from ..physics.mesh import mesh_from_mask
from ..physics.scene import Body
from .composite import hidden_by, mask_of_layer
from .parts import about

if TYPE_CHECKING:
    from .artwork import Artwork, LayerPlan

__all__ = ["bodies_of_moving"]


def bodies_of_moving(
    artwork: Artwork, plans: Sequence[LayerPlan], known: Mapping[int, tuple[Body, NDArray[np.float32]]]
) -> list[tuple[Body, NDArray[np.float32]]]:
    """The layers that move as bodies with their masks, from back to front; those that are bodies already stay.

    Args:
        artwork: the layers.
        plans: of the layers that move, in the artwork's order.
        known: body and mask of layers that are bodies, by the layer's index.

    Raises:
        InvalidInputError: a layer gives no mesh.
    """
    moving = [plan.index for plan in plans]
    made = []
    for rank, plan in enumerate(plans):
        cover = hidden_by(artwork, plan.index, moving=moving)
        if plan.index in known:
            body, mask = known[plan.index]
            made.append((replace(body, layer=rank, name=plan.name, cover=cover), mask))
            continue
        mask = mask_of_layer(artwork, plan.index)
        with about(f"layer {plan.name}"):
            mesh = mesh_from_mask(mask)
        made.append((Body(mesh, preset(plan.preset or "hair"), rank, plan.name, cover), mask))
    return made
