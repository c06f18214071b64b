"""Which layers of an artwork move: the bodies that they become, and what draws them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..physics.errors import InvalidInputError, require
from ..physics.material import Material, preset
from ..physics.motion import Motion
from ..physics.scene import Body
from .composite import LayeredRenderer
from .parts import OF_STRANDS, Parts, arranged, parts_of_artwork, picture_of

if TYPE_CHECKING:
    from .artwork import Artwork, LayerPlan

__all__ = [
    "LayerBodies",
    "LayerSource",
    "MovingLayers",
    "bodies_before",
    "bodies_of_layers",
    "moving_layers_of",
    "told_layers",
]

Image = NDArray[Any]

_MIXED = "bodies of layers and bodies of masks cannot be in one picture: use one of them for all."


@dataclass(frozen=True, eq=False, repr=False)
class LayerSource:
    """The layer that a body is.

    Attributes:
        artwork: all layers, those visible that are drawn.
        index: of the layer, from the back.
    """

    artwork: Artwork
    index: int


@dataclass(frozen=True, eq=False, repr=False)
class MovingLayers:
    """The layers of an artwork that a motion moves.

    Attributes:
        artwork: all layers, those visible that are drawn.
        indices: the layer that each body of the motion is.
    """

    artwork: Artwork
    indices: tuple[int, ...]

    @property
    def picture(self) -> Image:
        """The artwork at rest: RGB, or straight RGBA where it has transparency, uint8 or float32."""
        return picture_of(self.artwork)

    def renderer(self, motion: Motion) -> LayeredRenderer:
        """What draws a motion of the layers."""
        return LayeredRenderer.of_artwork(self.artwork, self.indices, motion)

    def own_sketches(self) -> list[Image]:
        """Lines of each moving layer alone, hidden ones included: paper 1, lines 0, shape [h, w] each."""
        from .artwork import flattened
        from .pictures import over
        from .sketch import extract_sketch

        alone = ([replace(self.artwork.layers[index], blend="normal")] for index in self.indices)
        return [extract_sketch(over(flattened(self.artwork, layers))) for layers in alone]

    def sketch_behind(self, motion: Motion) -> Image:
        """Lines of what stands still, as they show where all that moves is gone, shape [h, w]."""
        from .pictures import over
        from .sketch import extract_sketch

        return extract_sketch(over(self.renderer(motion).plate))


def moving_layers_of(sources: Sequence[LayerSource | None]) -> MovingLayers | None:
    """The layers that bodies are; None where they are cut out by masks.

    Args:
        sources: of each body.

    Raises:
        InvalidInputError: some are layers and others are not, or they are layers of several pictures, or one twice.
    """
    known = [source for source in sources if source is not None]
    if not known:
        return None
    require("bodies", "both", len(known) == len(sources), _MIXED)
    artwork, indices = known[0].artwork, tuple(source.index for source in known)
    if any(source.artwork is not artwork for source in known):
        raise InvalidInputError("all bodies must be layers of one picture. Got: layers of several")
    if len(set(indices)) < len(indices):
        raise InvalidInputError("each layer can be one body. Got: a layer twice")
    return MovingLayers(artwork, indices)


@dataclass(frozen=True, eq=False)
class LayerBodies:
    """Layers as bodies.

    Attributes:
        parts: the layers.
        bodies: of the parts, from back to front.
        sources: the layer that each body is.
        plans: what becomes of every layer of the artwork, moving or not.
    """

    parts: Parts
    bodies: tuple[Body, ...]
    sources: tuple[LayerSource, ...]
    plans: tuple[LayerPlan, ...]


def bodies_of_layers(
    artwork: Artwork,
    *,
    move: Sequence[str] = (),
    still: Sequence[str] = (),
    material: Material | str | None = None,
    spacing: float | None = None,
    elements_across: int | None = None,
    strands: bool = True,
    before: Mapping[int, Body] | None = None,
) -> LayerBodies:
    """The layers that move as bodies.

    Args:
        artwork: the layers.
        move: names of layers that move, whatever the table of names says; ``NAME=PRESET`` also says how.
        still: names of layers that stand still.
        material: of all that move, or the name of its preset, instead of what suits each; ``NAME=PRESET`` stands above.
        spacing: distance of the meshes' vertices [px]; None chooses it.
        elements_across: triangles across thin strands; None for the usual number.
        strands: slit hair and ribbons along the lines that are drawn between their strands, so that these swing apart.
        before: bodies that layers of this artwork are already, by the layers' index.

    Raises:
        InvalidInputError: there is no such layer, none moves, or one gives no mesh.
    """
    from .artwork import moving_layers

    before, names = before or {}, artwork.names
    for plan in _asked(artwork, move):
        require("move", plan.name, plan.index not in before, "of layers that are no bodies yet")
    with_preset = {plan.index for plan in _asked(artwork, [each for each in move if "=" in each and each not in names])}
    move = [*(names[index] for index in before), *move]
    plans = moving_layers(artwork, move, still)
    parts = parts_of_artwork(artwork, move=move, still=still, spacing=spacing, elements_across=elements_across)
    moving = [plan for plan in plans if plan.moves and plan.name in parts.names]
    materials = [_material(plan, None if plan.index in with_preset else material) for plan in moving]
    split = [
        strands and made.name in OF_STRANDS and plan.index not in before
        for plan, made in zip(moving, materials, strict=True)
    ]
    whole, parts = parts.meshes, parts.in_strands(split, parts.attachments)
    slit = [mesh is not before_it for mesh, before_it in zip(parts.meshes, whole, strict=True)]
    bodies = parts.bodies(materials, slit)
    for number, plan in enumerate(moving):
        if plan.index in before:
            kept = {name: getattr(before[plan.index], name) for name in ("mesh", "material", "strands")}
            bodies[number] = replace(bodies[number], **kept)
    shown = arranged(artwork, move, still)
    return LayerBodies(parts, tuple(bodies), tuple(LayerSource(shown, plan.index) for plan in moving), plans)


def bodies_before(artwork: Artwork, before: Sequence[tuple[LayerSource | None, Body]]) -> dict[int, Body]:
    """Bodies that layers of an artwork are already, by the layers' index.

    Args:
        artwork: the layers.
        before: bodies, and the layers that they are.

    Raises:
        InvalidInputError: a body is cut out by a mask, or a layer of another artwork.
    """
    layers = moving_layers_of([source for source, _ in before])
    require("bodies", "bodies of masks", layers is not None or not before, _MIXED)
    if layers is not None and not _alike(layers.artwork, artwork):
        raise InvalidInputError("bodies must be of layers of the same artwork. Got: those of another")
    return {source.index: body for source, body in before if source is not None}


def _alike(one: Artwork, other: Artwork) -> bool:
    """Whether two artworks hold the same layers in the same places; which are shown does not count."""
    if (one.width, one.height, one.names) != (other.width, other.height, other.names):
        return False
    pairs = zip(one.layers, other.layers, strict=True)
    return all(a.box == b.box and np.array_equal(a.pixels, b.pixels) for a, b in pairs)


def told_layers(plans: Sequence[LayerPlan]) -> str:
    """What becomes of each layer and why, a line each, from front to back."""
    return "\n".join(f"{plan.name}: {_fate(plan)} ({plan.why})" for plan in reversed(plans))


def _fate(plan: LayerPlan) -> str:
    if plan.moves:
        return f"moves as {plan.preset}"
    return "stands still" if plan.shown else "is not drawn"


def _asked(artwork: Artwork, move: Sequence[str]) -> list[LayerPlan]:
    """The layers that somebody named."""
    from .artwork import moving_layers

    return [plan for plan in moving_layers(artwork, move) if plan.moves and plan.asked]


def _material(plan: LayerPlan, chosen: Material | str | None) -> Material:
    return chosen if isinstance(chosen, Material) else preset(chosen or plan.preset or "hair")
