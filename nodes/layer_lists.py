"""Lists of an artwork's layers, as nodes tell them to the page and make bodies of them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ..rendering.artwork import rule_of
from .host import send_to_page
from .host.wires import MaskedBody

if TYPE_CHECKING:
    from ..physics.scene import Held
    from ..rendering.artwork import Artwork, LayerPlan
    from ..rendering.layer_bodies import LayerBodies

__all__ = ["LAYERS_EVENT", "listed_layers", "masked_bodies", "tell_layers", "told_list", "usual_attachment"]

LAYERS_EVENT = "physanimator.layers"
"""Name of the message by which a list of layers appears in a node that has refused to go on: see nodes/web/js/host."""


def told_list(artwork: Artwork, layers: list[dict[str, Any]]) -> dict[str, Any]:
    """What a list of layers in a node shows: see :func:`listed_layers`."""
    return {"width": artwork.width, "height": artwork.height, "layers": layers}


def listed_layers(
    plans: Sequence[LayerPlan], before: Mapping[str, str], held: Mapping[str, Held], moving: Collection[int] = ()
) -> list[dict[str, Any]]:
    """What the page is told of layers, from front to back.

    Args:
        plans: what becomes of every layer, from back to front.
        before: the preset of each layer that moves unless a scene document says otherwise, by its name.
        held: where layers are held that are bodies already, unless a scene document says otherwise, by their names.
        moving: indices of the layers that move.
    """
    return [
        {
            "index": plan.index,
            "name": plan.name,
            "shown": plan.shown,
            "moves": plan.name in before,
            "moving": plan.index in moving,
            "fixed": plan.asked,
            "why": plan.why,
            **_suiting(plan, before.get(plan.name), held.get(plan.name)),
        }
        for plan in reversed(plans)
    ]


def _suiting(plan: LayerPlan, preset: str | None, attach: Held | None) -> dict[str, str]:
    """Of what a layer is and where it is held, or would be if it moved."""
    preset = preset or plan.preset or rule_of(plan.name).preset or "hair"
    return {"preset": preset, "attach": attach or usual_attachment(plan)}


def usual_attachment(plan: LayerPlan) -> Held:
    """Where a layer is held by its name, whether it moves or not."""
    from ..rendering.layer_roots import attachment_of_layer

    rule = rule_of(plan.name)
    return attachment_of_layer(replace(plan, preset=plan.preset or rule.preset, held=rule.held))


def tell_layers(artwork: Artwork, layers: list[dict[str, Any]]) -> None:
    """Show a list of layers in the node that is being executed, whatever becomes of it: see :func:`listed_layers`."""
    send_to_page(LAYERS_EVENT, told_list(artwork, layers))


def masked_bodies(made: LayerBodies) -> tuple[MaskedBody, ...]:
    """Layers as bodies, as they travel."""
    made_of = zip(made.bodies, made.parts.masks, made.attachments, made.sources, strict=True)
    return tuple(MaskedBody(body, mask, attach, source) for body, mask, attach, source in made_of)
