"""Layers that somebody chose as bodies, beside those that are bodies already."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..physics.document import bodies_named
from ..physics.errors import InvalidInputError, require
from ..physics.material import preset
from ..physics.mesh import mesh_from_mask
from ..physics.scene import Body
from .composite import hidden_by, mask_of_layer
from .layers_of_scenes import SCENE_SAYS
from .parts import OF_STRANDS, about, parts_of_artwork

if TYPE_CHECKING:
    from .artwork import Artwork, LayerPlan

__all__ = ["bodies_of_document", "bodies_of_moving"]

LayerBody = tuple[Body, NDArray[np.float32]]


def bodies_of_document(artwork: Artwork, document: Mapping[str, Any]) -> dict[int, LayerBody]:
    """The layers that move by a scene document and by their names, as bodies with their masks, by their index.

    Hair and ribbons are slit between the strands that are drawn on them, as in ``animate``.

    Args:
        artwork: the layers.
        document: a checked scene document.

    Raises:
        InvalidInputError: none moves, or one that the document names gives no mesh.
    """
    parts = parts_of_artwork(artwork, document=document)
    wanted = [name for name in bodies_named(document) if name in artwork.names and name not in parts.names]
    for note in parts.notes:
        require("layer", note, not any(f"layer {name}:" in note for name in wanted), "one that gives a mesh")
    materials = [preset(each or "hair") for each in parts.presets]
    said = {entry.get("name"): entry.get("strands") for entry in document.get("bodies", [])}
    suits = [
        made.name in OF_STRANDS if said.get(name) is None else said[name]
        for name, made in zip(parts.names, materials, strict=True)
    ]
    whole, parts = parts.meshes, parts.in_strands([bool(each) for each in suits], parts.attachments)
    slit = [mesh is not before for mesh, before in zip(parts.meshes, whole, strict=True)]
    bodies = zip(parts.names, parts.bodies(materials, slit), parts.masks, strict=True)
    return {artwork.names.index(name): (body, mask) for name, body, mask in bodies}


def bodies_of_moving(
    artwork: Artwork, plans: Sequence[LayerPlan], known: Mapping[int, LayerBody]
) -> dict[int, LayerBody]:
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


def _body(artwork: Artwork, plan: LayerPlan) -> LayerBody:
    mask = mask_of_layer(artwork, plan.index)
    with about(f"layer {plan.name}"):
        mesh = mesh_from_mask(mask)
    return Body(mesh, preset(plan.preset or "hair")), mask
