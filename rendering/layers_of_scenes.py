"""Layers of an artwork as scene documents speak of them: which of them move, and which stand still to be leant on."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..physics.document import bodies_named, still_layers
from ..physics.errors import InvalidInputError, printable

if TYPE_CHECKING:
    from ..physics.scene import Held
    from .artwork import Artwork, LayerPlan

__all__ = ["SCENE_SAYS", "attachments_in", "masks_of_still_layers", "nothing_moves", "planned_layers"]

SCENE_SAYS = "the scene says so"
"""Why a layer moves or stands still, in a plan of it."""

_SHOWN = 20


def planned_layers(
    artwork: Artwork,
    move: Sequence[str] = (),
    still: Sequence[str] = (),
    *,
    document: Mapping[str, Any] | None = None,
) -> tuple[LayerPlan, ...]:
    """Which layers move: by the user's word, otherwise by that of a scene document, otherwise by their names.

    Args:
        artwork: the layers.
        move: names of layers that move.
        still: names of layers that stand still.
        document: a checked scene document, whose bodies of a layer's name move, and whose "still" layers do not.

    Raises:
        InvalidInputError: there is no layer of a name in ``move`` or ``still``.
    """
    from .artwork import moving_layers, rule_of

    plans = moving_layers(artwork, move, still)
    if document is None:
        return plans
    moving, held = set(bodies_named(document)), set(still_layers(document))

    def settled(plan: LayerPlan) -> LayerPlan:
        if plan.asked or not plan.shown:  # what the user has hidden stays so
            return plan
        if plan.name in moving:
            preset = plan.preset or rule_of(plan.name).preset or "hair"
            return plan if plan.moves else replace(plan, moves=True, preset=preset, why=SCENE_SAYS)
        if plan.name in held and plan.moves:
            return replace(plan, moves=False, preset=None, held=None, why=SCENE_SAYS)
        return plan

    return tuple(map(settled, plans))


def attachments_in(document: Mapping[str, Any]) -> dict[str, Held]:
    """Where a checked scene document holds layers, by their names."""
    entries = document.get("bodies", [])
    return {entry["name"]: entry["attach"] for entry in entries if entry.get("name") and "attach" in entry}


def masks_of_still_layers(artwork: Artwork, moving: Collection[int]) -> Callable[[str], NDArray[np.bool_]]:
    """What gives the mask of a still layer by its name, bool, shape [h, w], for colliders.

    It raises InvalidInputError where no still layer has the name.

    Args:
        artwork: the layers.
        moving: indices of the layers that move.
    """
    from .composite import mask_of_layer

    names = artwork.names

    def mask_of(name: str) -> NDArray[np.bool_]:
        index = names.index(name) if name in names else None
        if index is None or index in moving:
            known = [each for number, each in enumerate(names) if number not in moving]
            listed = ", ".join(printable(each[:60]) for each in known[:_SHOWN]) or "none"
            more = " and others" if len(known) > _SHOWN else ""
            got = printable(name[:60]) + ("" if index is None else ", which moves")
            raise InvalidInputError(f"layer must be one that stands still; there are {listed}{more}. Got: {got}")
        mask = mask_of_layer(artwork, index) > 0.5
        if not mask.any():
            raise InvalidInputError(f"layer must have something drawn on it. Got: {printable(name[:60])}")
        mask.setflags(write=False)  # so that it need not be copied for each collider
        return mask

    return mask_of


def nothing_moves(names: Sequence[str]) -> str:
    """The sentence that says that no layer moves by its name, and what to do about it.

    Args:
        names: of the layers that are seen.
    """
    listed = ", ".join(f'"{printable(name[:60])}"' for name in names[:_SHOWN]) or "none that is seen"
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    example = printable(names[-1][:60]) if names else "NAME"
    return (
        "no layer moves by its name: switch on those that do in the list of layers of the node Artwork to Bodies or"
        " Scene Editor, or type their names into the input move of Artwork to Bodies, one on each line, or give them on"
        f' the command line as --move "{example}". Got the layers, from back to front: {listed}{more}'
    )
