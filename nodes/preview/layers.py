"""Layers for the editor: what the page draws of them, and which of them move where somebody has clicked."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...physics.document import scene_to_dict
from ...physics.errors import InvalidInputError
from ...physics.mesh import runs_of
from ..host import place_of
from .limits import MAX_FRAMES, MAX_PICKED_PIXELS, MAX_PICKED_SIZE
from .store import PreviewBodies, PreviewStore

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from ...physics.scene import Body
    from ...rendering.artwork import Artwork
    from ...rendering.layer_pictures import LayerPicture
    from ...rendering.movement import Movement
    from ...rendering.parts import Parts
    from ...rendering.picked_layers import PickedLayers

__all__ = ["BY_NAME", "artwork_to_pick", "cuts_of_layers", "drawn_layers", "layered_place", "moving_of_layers"]

BY_NAME = -1
"""Stands for the number of a part where a layer moves that nobody has picked."""


def drawn_layers(
    pictures: Sequence[LayerPicture], moving: Sequence[int], bodies: Sequence[Body]
) -> list[dict[str, Any]]:
    """What the page draws, from back to front.

    Args:
        pictures: of the layers, from back to front.
        moving: indices of the layers that the bodies are.
        bodies: what moves.
    """
    from ...physics.motion import layer_order

    order = [moving[number] for number in layer_order(bodies)]
    return [
        {
            "layer": each.layer,
            "body": order.index(each.layer) if each.layer in order else None,
            "box": list(each.box),
            "blend": each.blend,
        }
        for each in pictures
    ]


def layered_place(name: str) -> Path | None:
    """Where a layered file of the host's input folder is; None if the name is that of something else."""
    from ...rendering.artwork import is_artwork_file

    try:
        place = place_of(name)
    except InvalidInputError:
        return None
    return place if is_artwork_file(place) else None


def artwork_to_pick(place: Path) -> Artwork | NDArray[np.uint8]:
    """A layered file; where it has no layer that could move alone, its picture.

    Raises:
        InvalidInputError: it cannot be read, or is too large to be cut while somebody clicks.
    """
    from ...rendering.artwork import load_artwork
    from ...rendering.picked_layers import flat_picture
    from ...rendering.pictures import as_uint8

    artwork = load_artwork(place)
    if artwork.width * artwork.height > MAX_PICKED_PIXELS:
        raise InvalidInputError(
            f"A picture of {artwork.width} x {artwork.height} px is too large to be cut while you click: click on what"
            " shall move, then run this node."
        )
    flat = flat_picture(artwork)
    return artwork if flat is None else as_uint8(flat)


def cuts_of_layers(artwork: Artwork, picked: PickedLayers) -> list[dict[str, Any]]:
    """What is seen of each layer that moves, in the form of a scene document's painted regions.

    Of many layers of a large picture only every n-th pixel each way.
    """
    from ...rendering.composite import hidden_by, mask_of_layer

    step = math.ceil(math.sqrt(len(picked.moving) * artwork.width * artwork.height / MAX_PICKED_SIZE)) or 1
    cuts = []
    for index in picked.moving:
        mask, cover = mask_of_layer(artwork, index) > 0.5, hidden_by(artwork, index, moving=())
        seen = (mask if cover is None else mask & ~cover)[::step, ::step]
        region = {"type": "mask", "width": seen.shape[1], "height": seen.shape[0], "runs": runs_of(seen)}
        cuts.append({"part": picked.parts.get(index, BY_NAME), **region})
    return cuts


def moving_of_layers(
    artwork: Artwork, parts: Parts, picked: PickedLayers, how: Movement, frames: int, store: PreviewStore
) -> dict[str, Any]:
    """The bodies' key, the scene that moves them, and what to draw.

    Args:
        artwork: the layers.
        parts: those that move.
        picked: what becomes of each layer.
        how: they move.
        frames: of the motion.
        store: takes the bodies.
    """
    from ...rendering.layer_pictures import layer_pictures
    from ...rendering.layers_of_scenes import masks_of_still_layers
    from ...rendering.parts import with_shown

    presets = {plan.name: plan.preset for plan in picked.plans}
    parts, scene = how.staged(replace(parts, presets=tuple(presets[name] for name in parts.names)))
    shown = with_shown(artwork, picked.plans)
    moving = [artwork.names.index(name) for name in parts.names]
    pictures = layer_pictures(shown, moving)
    stored = PreviewBodies(
        scene.bodies,
        layers=pictures,
        layer_masks=masks_of_still_layers(shown, moving),
        layer_bytes=sum(layer.pixels.nbytes for layer in artwork.layers),
        attachments=parts.attachments,
    )
    return {
        "key": store.put(stored),
        "scene": scene_to_dict(scene, meshes=False),
        "frames": min(frames, MAX_FRAMES),
        "drawn": drawn_layers(pictures, moving, scene.bodies),
    }
