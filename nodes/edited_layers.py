"""The layers of an artwork in the scene editor: which of them move by what its document says, and their pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ..physics.errors import InvalidInputError
from .host.wires import MaskedBody
from .layer_lists import listed_layers, masked_bodies, tell_layers, usual_attachment
from .preview.layers import drawn_layers

if TYPE_CHECKING:
    from ..physics.document import LayerMasks
    from ..physics.scene import Held
    from ..rendering.artwork import Artwork, LayerPlan
    from ..rendering.layer_pictures import LayerPicture

__all__ = ["EditedLayers", "edited_layers"]


class EditedLayers:
    """An artwork as the editor shows it.

    Attributes:
        bodies: what moves, from back to front.
        pictures: of the visible layers, from back to front.
        masks: gives the mask of a still layer by its name.
        memory: of the artwork [bytes].
        attachments: where each body is held unless the document says otherwise.
    """

    def __init__(
        self,
        artwork: Artwork,
        bodies: tuple[MaskedBody, ...],
        before: Mapping[str, str],
        held: Mapping[str, Held],
        plans: Sequence[LayerPlan],
    ) -> None:
        """
        Args:
            artwork: the layers, those visible that are drawn.
            bodies: what moves, from back to front.
            before: the preset of each layer that moves unless the document says otherwise, by its name.
            held: where layers are held that came as bodies, by their names.
            plans: what becomes of every layer.
        """
        from ..rendering.layer_pictures import layer_pictures
        from ..rendering.layers_of_scenes import masks_of_still_layers

        self.bodies = bodies
        self._before, self._held, self._plans = before, held, plans
        self._moving = [item.source.index for item in bodies if item.source is not None]
        self.pictures: tuple[LayerPicture, ...] = layer_pictures(artwork, self._moving)
        self.masks: LayerMasks = masks_of_still_layers(artwork, self._moving)
        self.memory = sum(layer.pixels.nbytes for layer in artwork.layers)
        self.attachments = tuple(
            held.get(item.body.name) or usual_attachment(plans[index])
            for item, index in zip(bodies, self._moving, strict=True)
        )

    def told(self) -> dict[str, Any]:
        """What the page is told: the layers from front to back, and what to draw from back to front."""
        drawn = drawn_layers(self.pictures, self._moving, [item.body for item in self.bodies])
        return {"layers": listed_layers(self._plans, self._before, self._held, self._moving), "drawn": drawn}

    def held_unless_said(self, document: Mapping[str, Any]) -> list[MaskedBody]:
        """The bodies, of which those say where they are held that the document has no word of.

        So a picture is held from the start, and so is a layer that comes later. Whoever has drawn rig points has his
        word on the layers that the document names.
        """
        entries = {entry["name"]: entry for entry in document.get("bodies", []) if entry.get("name")}

        def held(item: MaskedBody) -> MaskedBody:
            entry = entries.get(item.body.name)
            said = entry is not None and ("attach" in entry or "rig_points" in document)
            return item if said else replace(item, body=replace(item.body, attach=item.attach))

        return [held(item) for item in self.bodies]


def edited_layers(
    document: Mapping[str, Any], bodies: tuple[MaskedBody, ...], artwork: Artwork | None
) -> EditedLayers | None:
    """The layers that move by what a scene document says; None where masks cut the bodies out.

    Args:
        document: a checked scene document.
        bodies: from other nodes.
        artwork: what is connected to the input for layers.

    Raises:
        InvalidInputError: nothing moves, or bodies and layers do not belong together.
    """
    from ..physics.document import order_of_layers
    from ..rendering.artwork import in_order
    from ..rendering.layer_bodies import bodies_before, bodies_of_layers
    from ..rendering.layers_of_scenes import nothing_moves, planned_layers
    from ..rendering.moving_layers import moving_layers_of
    from ..rendering.parts import arranged

    given = moving_layers_of([item.source for item in bodies])
    if given is None and (bodies or artwork is None):
        return None
    shown = given.artwork if given is not None else arranged(artwork)
    ordered = in_order(shown, order_of_layers(document))
    names = ordered.names
    held = {item.body.name: item.attach for item in bodies}
    before = {item.body.name: item.body.material.name for item in bodies}
    if not bodies:
        before = {plan.name: plan.preset or "hair" for plan in planned_layers(shown) if plan.moves}
    plans = [_settled(plan, before, document) for plan in planned_layers(ordered, document=document)]
    moving = [plan.name for plan in plans if plan.moves]
    if not moving:
        tell_layers(ordered, listed_layers(plans, before, held))
        raise InvalidInputError(nothing_moves([names[plan.index] for plan in plans if plan.shown]))
    if set(moving) == held.keys() and ordered is shown:
        return EditedLayers(shown, bodies, before, held, plans)
    earlier = bodies_before(shown, [(item.source, item.body, item.attach) for item in bodies])
    made = bodies_of_layers(shown, before=earlier, document=document, plans=plans)
    chain = masked_bodies(made)
    # What would move by its name, but gives no mesh, stands still.
    gone = set(moving) - {item.body.name for item in chain}
    before = {name: material for name, material in before.items() if name not in gone}
    return EditedLayers(chain[0].source.artwork, chain, before, held, plans)


def _settled(plan: LayerPlan, before: Mapping[str, str], document: Mapping[str, Any]) -> LayerPlan:
    """The plan of a layer that moves as the document says, otherwise as it came."""
    from ..physics.document import bodies_named, still_layers

    named = plan.shown and plan.name in bodies_named(document)
    moves = named or (plan.name in before and plan.name not in still_layers(document))
    if moves == plan.moves:
        return plan
    return replace(plan, moves=moves, preset=(plan.preset or "hair") if moves else None)
