"""Groups of layers: what a group says is carried to the layers in it, so that the picture stays the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.limits import MAX_PICTURE_PIXELS
from .artwork import ArtLayer, Blend
from .blending import lay_over, planes_of
from .flattening import as_whole_numbers, laid_together

__all__ = ["carried_down", "clipped", "extent_of", "masked", "merged", "shut_in"]

Box = tuple[int, int, int, int]

_MOST_PIXELS = 4 * MAX_PICTURE_PIXELS


def carried_down(
    layers: Sequence[ArtLayer], *, name: str, opacity: float = 1.0, blend: Blend = "normal", visible: bool = True
) -> tuple[list[ArtLayer], list[str]]:
    """The layers of a group, with what the group says of itself carried to each.

    A see-through group is see-through as one picture: where its layers overlap, the lower ones are thinned by just so
    much that the sum is the same. A group with a blend mode of its own whose layers overlap becomes one layer.

    Args:
        layers: of the group, from back to front.
        name: of the group.
        opacity: of the group, 0 to 1.
        blend: of the group.
        visible: of the group.

    Returns:
        The layers, and a sentence for each thing that is lost.
    """
    shown = [replace(layer, visible=layer.visible and visible) for layer in layers]
    drawn = [layer for layer in shown if layer.visible]
    plain = blend == "normal"
    if (opacity == 1 and plain) or not _overlap(drawn):
        return [
            replace(layer, opacity=layer.opacity * opacity, blend=layer.blend if plain else blend) for layer in shown
        ], []
    if not plain:
        one = merged(drawn, name=name, opacity=opacity, blend=blend)
        return [*[layer for layer in shown if not layer.visible], one], [
            f"group {name} is laid over as {blend} with layers that overlap: it is read as one layer"
        ]
    return _thinned(shown, opacity), [
        f"group {name} is see-through and its layers overlap: what they hide of one another is left out"
    ]


def merged(layers: Sequence[ArtLayer], *, name: str, opacity: float = 1.0, blend: Blend = "normal") -> ArtLayer:
    """Layers as one."""
    box = extent_of(layers)
    pixels = laid_together(layers, box, layers[0].pixels.dtype)
    return ArtLayer(name, pixels, left=box[0], top=box[1], opacity=opacity, blend=blend)


def shut_in(layers: Sequence[ArtLayer], name: str) -> list[str]:
    """A sentence for each layer that in its group mixes with what is in the group alone, and here with all below.

    Args:
        layers: that are drawn, of a group that is laid over as one picture, from back to front.
        name: of the group.
    """
    if all(layer.blend == "normal" for layer in layers):
        return []
    left, top, right, bottom = extent_of(layers)
    through = np.ones((bottom - top, right - left), np.float32)
    remarks = []
    for layer in layers:
        x0, y0, x1, y1 = layer.box
        place = through[y0 - top : y1 - top, x0 - left : x1 - left]
        alpha = layer.pixels[..., 3] * np.float32(layer.opacity / np.iinfo(layer.pixels.dtype).max)
        if layer.blend != "normal" and (alpha * place > 0.01).any():
            remarks.append(
                f"layer {layer.name} is laid over as {layer.blend} and reaches beyond what is drawn in group {name}:"
                " there it changes what is behind the group, too"
            )
        place *= 1 - alpha
    return remarks


def clipped(base: ArtLayer, above: Sequence[ArtLayer]) -> ArtLayer:
    """A layer with others clipped to it: they change its colours, and its alpha is left as it is."""
    pixels = base.pixels.copy()
    left, top, right, bottom = base.box
    for layer in above:
        x0, x1 = max(left, layer.box[0]), min(right, layer.box[2])
        y0, y1 = max(top, layer.box[1]), min(bottom, layer.box[3])
        if not layer.visible or x0 >= x1 or y0 >= y1:
            continue
        part = pixels[y0 - top : y1 - top, x0 - left : x1 - left, :3]
        # As if the base were opaque; where it is not, this is seen as little as the base itself.
        opaque = np.full((*part.shape[:2], 4), np.iinfo(part.dtype).max, part.dtype)
        opaque[..., :3] = part
        planes = planes_of(opaque)
        over = layer.pixels[y0 - layer.top : y1 - layer.top, x0 - layer.left : x1 - layer.left]
        lay_over(planes, planes_of(over, layer.opacity), layer.blend)
        part[...] = as_whole_numbers(np.clip(planes[..., :3], 0, 1), part.dtype)
    return replace(base, pixels=pixels)


def masked(
    layer: ArtLayer, mask: NDArray[Any], left: int, top: int, outside: float, *, at_most: bool = False
) -> ArtLayer:
    """A layer with its alpha times a mask.

    Args:
        layer: the layer.
        mask: 0 to 1, float32, shape [h, w].
        left: column of the canvas where the mask begins [px].
        top: row of the canvas where the mask begins [px].
        outside: what the mask is where it has no pixels, 0 to 1.
        at_most: cut the alpha down to the mask instead.
    """
    own_left, own_top, own_right, own_bottom = layer.box
    factor = np.full(layer.pixels.shape[:2], outside, np.float32)
    x0, x1 = max(left, own_left), min(left + mask.shape[1], own_right)
    y0, y1 = max(top, own_top), min(top + mask.shape[0], own_bottom)
    if x0 < x1 and y0 < y1:
        inside = mask[y0 - top : y1 - top, x0 - left : x1 - left]
        factor[y0 - own_top : y1 - own_top, x0 - own_left : x1 - own_left] = inside
    if at_most:
        alpha = layer.pixels[..., 3] / np.float32(np.iinfo(layer.pixels.dtype).max)
        factor = np.minimum(alpha, factor) / np.maximum(alpha, np.float32(1e-6))
    return _times(layer, factor)


def extent_of(layers: Sequence[ArtLayer]) -> Box:
    """The box around layers; an empty one where there is nothing.

    Raises:
        InvalidInputError: it is far larger than any canvas.
    """
    boxes = [layer.box for layer in layers if layer.pixels.size]
    if not boxes:
        return 0, 0, 0, 0
    left, top = min(box[0] for box in boxes), min(box[1] for box in boxes)
    right, bottom = max(box[2] for box in boxes), max(box[3] for box in boxes)
    if (right - left) * (bottom - top) > _MOST_PIXELS:
        raise InvalidInputError(
            f"layers of a group must lie within {_MOST_PIXELS / 1e6:.0f} million pixels; move what is far outside"
            f" the canvas. Got: {right - left} x {bottom - top} px"
        )
    return left, top, right, bottom


def _overlap(layers: Sequence[ArtLayer]) -> bool:
    """Whether two layers have pixels at one place."""
    left, top, right, bottom = extent_of(layers)
    taken = np.zeros((bottom - top, right - left), bool)
    for layer in layers:
        x0, y0, x1, y1 = layer.box
        place = taken[y0 - top : y1 - top, x0 - left : x1 - left]
        there = layer.pixels[..., 3] > 0
        if (place & there).any():
            return True
        place |= there
    return False


def _thinned(layers: Sequence[ArtLayer], opacity: float) -> list[ArtLayer]:
    """Layers of a see-through group, each with what those in front leave of it.

    With T the product of (1 - a) over the layers in front, a layer's share in the group's picture is a T. Laid over
    one by one with alphas a', the shares are to be ``opacity`` times that: a' = opacity a T / (1 - opacity (1 - T)).
    """
    left, top, right, bottom = extent_of([layer for layer in layers if layer.visible])
    through = np.ones((bottom - top, right - left), np.float32)
    result = []
    for layer in reversed(layers):
        if layer.visible and layer.pixels.size:
            x0, y0, x1, y1 = layer.box
            place = through[y0 - top : y1 - top, x0 - left : x1 - left]
            alpha = layer.pixels[..., 3] * np.float32(layer.opacity / np.iinfo(layer.pixels.dtype).max)
            thinner = _times(layer, place / (1 - np.float32(opacity) * (1 - place)))
            place *= 1 - alpha
            layer = thinner
        result.append(replace(layer, opacity=layer.opacity * opacity))
    return result[::-1]


def _times(layer: ArtLayer, factor: NDArray[np.float32]) -> ArtLayer:
    pixels = layer.pixels.copy()
    pixels[..., 3] = np.rint(pixels[..., 3] * factor).astype(pixels.dtype)
    return replace(layer, pixels=pixels)
