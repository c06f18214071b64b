"""Which layers of an artwork move, and what draws them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from ..physics.errors import InvalidInputError, require
from ..physics.motion import Motion
from .composite import LayeredRenderer
from .parts import picture_of

if TYPE_CHECKING:
    from .artwork import Artwork, LayerPlan

__all__ = [
    "MIXED",
    "LayerSource",
    "MovingLayers",
    "moving_layers_of",
    "told_layers",
]

Image = NDArray[Any]

MIXED = "bodies of layers and bodies of masks cannot be in one picture: use one of them for all."
"""What bodies must not be, as the sentence that refuses them has it."""


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
    require("bodies", "both", len(known) == len(sources), MIXED)
    artwork, indices = known[0].artwork, tuple(source.index for source in known)
    if any(source.artwork is not artwork for source in known):
        raise InvalidInputError("all bodies must be layers of one picture. Got: layers of several")
    if len(set(indices)) < len(indices):
        raise InvalidInputError("each layer can be one body. Got: a layer twice")
    return MovingLayers(artwork, indices)


def told_layers(plans: Sequence[LayerPlan]) -> str:
    """What becomes of each layer and why, a line each, from front to back."""
    return "\n".join(f"{plan.name}: {_fate(plan)} ({plan.why})" for plan in reversed(plans))


def _fate(plan: LayerPlan) -> str:
    if plan.moves:
        return f"moves as {plan.preset}"
    return "stands still" if plan.shown else "is not drawn"
