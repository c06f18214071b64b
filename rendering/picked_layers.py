"""Layers that somebody has picked by points on the picture: a point is on the layer that is seen there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..physics.document import order_of_layers, parse_points
from ..physics.errors import printable
from .picked_parts import AUTO, presets_in

if TYPE_CHECKING:
    from ..physics.scene import QueryPoint
    from .artwork import Artwork, LayerPlan

__all__ = ["NOTHING_MOVES", "PickedLayers", "flat_picture", "picked_layers"]

NOTHING_MOVES = "no layer moves by its name: click on what shall move."
"""What to do where nothing is picked and no name says what moves."""

PICKED = "picked on the picture"
_SEEN = 0.25  # alpha of what is seen rather than shone through
_FULL = 0.98  # share of the canvas that a backdrop fills


@dataclass(frozen=True, eq=False)
class PickedLayers:
    """What becomes of the layers of an artwork.

    Attributes:
        plans: of every layer, from the back, in the order that the document says.
        parts: number of the part of each picked layer that moves, by the layer's index.
        told: sentences about points that pick nothing.
    """

    plans: tuple[LayerPlan, ...]
    parts: dict[int, int]
    told: tuple[str, ...]

    @property
    def moving(self) -> list[int]:
        """Indices of the layers that move."""
        return [plan.index for plan in self.plans if plan.moves]


def picked_layers(
    artwork: Artwork,
    points: str | Mapping[str, Any] | None,
    *,
    usual: str = AUTO,
    document: Mapping[str, Any] | None = None,
) -> PickedLayers:
    """What moves by name, or by a scene document, with the layers on which points are; those beside stand still.

    Args:
        artwork: the layers.
        points: in any form that :func:`~physanimator.physics.document.parse_points` takes, on the whole canvas. The
            layer in front at a positive point moves, that at a negative one stands still; of one layer the last point
            counts. A scene document's ``bodies`` say what the parts are made of. None for no points.
        usual: name of the material of all that move and of which nothing is said; ``AUTO`` for what a layer's name
            says, or hair.
        document: a checked scene document that says which layers move, and in which order they lie.

    Raises:
        InvalidInputError: the points are none.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import ArtLayer, Artwork
        >>> from physanimator.rendering.picked_layers import picked_layers
        >>> dot = np.full((4, 4, 4), 255, np.uint8)
        >>> art = Artwork(20, 20, (ArtLayer("Layer 1", dot), ArtLayer("Layer 2", dot, left=9)))
        >>> [plan.moves for plan in picked_layers(art, "[[10, 1]]").plans]
        [False, True]
    """
    from .artwork import in_order
    from .layers_of_scenes import planned_layers

    ordered = in_order(artwork, order_of_layers(document or {}))
    plans = list(planned_layers(ordered, document=document))
    if usual != AUTO:
        plans = [replace(plan, preset=usual) if plan.moves else plan for plan in plans]
    found = parse_points(points, width=artwork.width, height=artwork.height) if points else []
    own, parts, told = presets_in(points or ""), dict[int, int](), list[str]()
    for point in found:
        part = f"Part {point.part + 1}: "
        index = _layer_at(ordered, plans, point)
        if index is None:
            told.append(f"{part}there is no layer at {point.x:g}, {point.y:g}.")
        elif not point.positive:
            parts.pop(index, None)
            plans[index] = replace(plans[index], moves=False, preset=None, held=None, why=PICKED, asked=True)
        elif _fills(ordered, index):
            told.append(
                f"{part}the layer {printable(plans[index].name[:60])} fills the whole picture and stands still: click"
                " on a layer in front of it, or save the picture flat, as PNG, to pick parts within it."
            )
        else:
            parts[index] = point.part
            plans[index] = _moving(plans[index], own.get(point.part), usual)
    return PickedLayers(tuple(plans), parts, tuple(dict.fromkeys(told)))


def flat_picture(artwork: Artwork) -> Any | None:
    """The picture of an artwork in which parts are picked as in a flat one: it has no layer that could move alone.

    Returns:
        RGB or straight RGBA, uint8 or float32, shape [h, w, 3 or 4]; None where there are layers to pick.
    """
    from .artwork import moving_layers
    from .parts import picture_of

    plans = [plan for plan in moving_layers(artwork) if plan.shown]
    alone = len(plans) == 1 and not plans[0].moves
    return picture_of(artwork) if alone else None


def _moving(plan: LayerPlan, own: str | None, usual: str) -> LayerPlan:
    from .artwork import rule_of

    rule = rule_of(plan.name)
    preset = own or (usual if usual != AUTO else plan.preset or rule.preset or "hair")
    return replace(plan, moves=True, preset=preset, held=plan.held or rule.held, why=PICKED, asked=True)


def _layer_at(artwork: Artwork, plans: Sequence[LayerPlan], point: QueryPoint) -> int | None:
    """The layer in front at a point: the first that is seen there, else the first that shines through."""
    there = list(_layers_at(artwork, plans, point))
    seen = [index for index, alpha in there if alpha >= _SEEN]
    return next(iter([*seen, *(index for index, _ in there)]), None)


def _layers_at(artwork: Artwork, plans: Sequence[LayerPlan], point: QueryPoint) -> Iterator[tuple[int, float]]:
    """Layers that have colour at a point, from the front, with their alpha there; light and shade do not count."""
    for index in range(len(plans) - 1, -1, -1):
        layer = artwork.layers[index]
        column, row = int(point.x) - layer.left, int(point.y) - layer.top
        height, width = layer.pixels.shape[:2]
        drawn = plans[index].shown and layer.blend == "normal"
        if drawn and 0 <= row < height and 0 <= column < width and layer.pixels[row, column, 3]:
            yield index, layer.opacity * float(layer.pixels[row, column, 3]) / float(np.iinfo(artwork.dtype).max)


def _fills(artwork: Artwork, index: int) -> bool:
    """Whether a layer is a backdrop, which would leave nothing behind it."""
    layer = artwork.layers[index]
    left, top = layer.left, layer.top
    inside = layer.pixels[max(0, -top) : artwork.height - top, max(0, -left) : artwork.width - left, 3]
    return int(np.count_nonzero(inside)) >= _FULL * artwork.width * artwork.height
