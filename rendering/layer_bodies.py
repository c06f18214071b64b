"""Layers that somebody chose as bodies, beside those that are bodies already."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..physics.errors import InvalidInputError
from ..physics.material import preset
from ..physics.mesh import mesh_from_mask
from ..physics.scene import Body
from .composite import hidden_by, mask_of_layer
from .layers_of_scenes import SCENE_SAYS
from .parts import about

if TYPE_CHECKING:
    from .artwork import Artwork, LayerPlan

__all__ = ["bodies_of_moving"]


def bodies_of_moving(
    artwork: Artwork, plans: Sequence[LayerPlan], known: Mapping[int, tuple[Body, NDArray[np.float32]]]
) -> dict[int, tuple[Body, NDArray[np.float32]]]:
    """The layers that move as bodies with their masks, by their index, from back to front.

    Layers that are bodies already stay what they are. One that moves by its name alone, but gives no mesh, is left out.

    Args:
        artwork: the layers.
        plans: of the layers that move, in the artwork's order.
        known: body and mask of layers that are bodies, by the layer's index.

    Raises:
        InvalidInputError: a layer that somebody chose gives no mesh.
    """
    made = {}
    for plan in plans:
        try:
            made[plan.index] = known.get(plan.index) or _body(artwork, plan)
        except InvalidInputError:
            if plan.asked or plan.why == SCENE_SAYS:
                raise
    names = artwork.names
    for rank, (index, (body, mask)) in enumerate(made.items()):
        cover = hidden_by(artwork, index, moving=made.keys())
        made[index] = replace(body, layer=rank, name=names[index], cover=cover), mask
    return made


def _body(artwork: Artwork, plan: LayerPlan) -> tuple[Body, NDArray[np.float32]]:
    mask = mask_of_layer(artwork, plan.index)
    with about(f"layer {plan.name}"):
        mesh = mesh_from_mask(mask)
    return Body(mesh, preset(plan.preset or "hair")), mask
