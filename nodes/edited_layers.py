"""The layers of an artwork in the scene editor: which of them move by what its document says, and their pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..physics.errors import InvalidInputError, printable
from .host.wires import MaskedBody

if TYPE_CHECKING:
    from ..physics.document import LayerMasks
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
    """

    def __init__(
        self, artwork: Artwork, bodies: tuple[MaskedBody, ...], before: Mapping[int, str], plans: Sequence[LayerPlan]
    ) -> None:
        """
        Args:
            artwork: the layers, those visible that are drawn.
            bodies: what moves, from back to front.
            before: the preset of each layer that moves unless the document says otherwise, by its index.
            plans: what becomes of every layer.
        """
        from ..rendering.layer_pictures import layer_pictures
        from ..rendering.layers_of_scenes import masks_of_still_layers

        self.bodies = bodies
        self._artwork, self._before, self._plans = artwork, before, plans
        self._moving = [item.source.index for item in bodies if item.source is not None]
        self.pictures: tuple[LayerPicture, ...] = layer_pictures(artwork, self._moving)
        self.masks: LayerMasks = masks_of_still_layers(artwork, self._moving)
        self.memory = sum(layer.pixels.nbytes for layer in artwork.layers)

    def told(self) -> dict[str, Any]:
        """What the page is told: the layers from front to back, and what to draw from back to front."""
        from ..physics.motion import layer_order

        order = [self._moving[number] for number in layer_order([item.body for item in self.bodies])]
        layers = [
            {
                "index": plan.index,
                "name": plan.name,
                "shown": plan.shown,
                "moves": plan.index in self._before,
                "moving": plan.index in self._moving,
                "preset": self._before.get(plan.index) or plan.preset or "hair",
            }
            for plan in reversed(self._plans)
        ]
        drawn = [
            {
                "layer": each.layer,
                "body": order.index(each.layer) if each.layer in order else None,
                "box": list(each.box),
                "blend": each.blend,
            }
            for each in self.pictures
        ]
        return {"layers": layers, "drawn": drawn}


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
    from ..rendering.layer_bodies import bodies_of_document, bodies_of_moving
    from ..rendering.layers_of_scenes import planned_layers
    from ..rendering.moving_layers import LayerSource, moving_layers_of
    from ..rendering.parts import arranged

    given = moving_layers_of([item.source for item in bodies])
    if given is None and (bodies or artwork is None):
        return None
    shown = given.artwork if given is not None else arranged(artwork)
    known = {} if given is None else dict(zip(given.indices, bodies, strict=True))
    before = {index: item.body.material.name for index, item in known.items()}
    if not known:
        before = {plan.index: plan.preset or "hair" for plan in planned_layers(shown) if plan.moves}
    plans = planned_layers(shown, document=document)
    moving = [plan for plan in plans if _moves(plan, before, document)]
    if not moving:
        listed = ", ".join(printable(name[:60]) for name in shown.names[:20])
        raise InvalidInputError(
            "no layer moves: switch on what moves in the list of layers, or give a layer a name such as hair or ribbon."
            f" Got: {listed}"
        )
    if {plan.index for plan in moving} == known.keys():
        return EditedLayers(shown, bodies, before, plans)
    if known:
        made = bodies_of_moving(shown, moving, {index: (item.body, item.mask) for index, item in known.items()})
    else:
        made = bodies_of_document(shown, document)
    chain = tuple(MaskedBody(body, mask, source=LayerSource(shown, index)) for index, (body, mask) in made.items())
    # What would move by its name, but gives no mesh, stands still.
    gone = {plan.index for plan in moving} - made.keys()
    before = {index: name for index, name in before.items() if index not in gone}
    return EditedLayers(shown, chain, before, plans)


def _moves(plan: LayerPlan, before: Mapping[int, str], document: Mapping[str, Any]) -> bool:
    """Whether a layer moves: as the document says, otherwise as it came."""
    from ..physics.document import bodies_named, still_layers

    if plan.shown and plan.name in bodies_named(document):
        return True
    return plan.index in before and plan.name not in still_layers(document)
