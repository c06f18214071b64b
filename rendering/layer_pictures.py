"""Each layer of an artwork as a small picture of its own, for programs that lay them over one another themselves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .artwork import ArtLayer, Artwork, Blend

__all__ = ["MARGIN", "MAX_SHOWN_PIXELS", "SHOWN_BLENDS", "LayerPicture", "layer_pictures"]

MAX_SHOWN_PIXELS = 2**24
"""Pixels of all pictures together; more are scaled down."""

_LONGEST = 4096  # px on a side, as every graphics card takes
MARGIN = 2
"""Transparency around what is drawn [px], so that what bends beyond it shows nothing."""

SHOWN_BLENDS: tuple[Blend, ...] = ("normal", "multiply", "screen", "add")
"""Modes that graphics cards know."""


@dataclass(frozen=True, eq=False, repr=False)
class LayerPicture:
    """What is drawn on one layer.

    Attributes:
        layer: its index in the artwork, from the back.
        pixels: straight RGBA with the layer's opacity, uint8, shape [h, w, 4]; may be scaled down.
        box: left, top, width and height of what it shows, in pixels of the artwork.
        blend: how it mixes with what is below; never overlay, which graphics cards cannot do.
    """

    layer: int
    pixels: NDArray[np.uint8]
    box: tuple[int, int, int, int]
    blend: Blend


def layer_pictures(
    artwork: Artwork,
    moving: Sequence[int],
    *,
    most_pixels: int = MAX_SHOWN_PIXELS,
    longest: int = _LONGEST,
    blends: Sequence[Blend] = SHOWN_BLENDS,
) -> tuple[LayerPicture, ...]:
    """The visible layers of an artwork as pictures, from back to front.

    Laid over one another they give the artwork. A layer of another mode than ``blends`` becomes a normal one of the
    colours that it gives at rest.

    Args:
        artwork: the layers.
        moving: indices of the layers that move, which are blended normally.
        most_pixels: of all pictures together.
        longest: side of a picture at most [px].
        blends: modes that whoever shows the pictures knows, normal among them.
    """
    shown = [(index, _box(artwork, layer)) for index, layer in enumerate(artwork.layers) if layer.visible]
    boxes = {index: box for index, box in shown if box is not None}
    total = sum(box[2] * box[3] for box in boxes.values())
    scale = min(1.0, math.sqrt(most_pixels / max(total, 1)))
    step = int(0.7 / scale)
    if step > 1:  # much smaller: some pixels of each place are enough, and large canvases take no memory
        coarse = layer_pictures(
            _thinned(artwork, step), moving, most_pixels=most_pixels, longest=longest, blends=blends
        )
        return tuple(replace(each, box=_times(each.box, step)) for each in coarse)

    def drawn(index: int, box: tuple[int, int, int, int]) -> LayerPicture:
        blend: Blend = "normal" if index in moving else artwork.layers[index].blend
        known = blend if blend in blends else None
        return _picture(artwork, index, box, min(scale, longest / max(box[2:])), blend=known)

    return tuple(drawn(index, box) for index, box in boxes.items())


def _thinned(artwork: Artwork, step: int) -> Artwork:
    """The artwork with every n-th pixel of the canvas each way."""

    def thinned(layer: ArtLayer) -> ArtLayer:
        pixels = layer.pixels[-layer.top % step :: step, -layer.left % step :: step]
        return replace(layer, pixels=pixels, left=-(-layer.left // step), top=-(-layer.top // step))

    width, height = -(-artwork.width // step), -(-artwork.height // step)
    return replace(artwork, width=width, height=height, layers=tuple(map(thinned, artwork.layers)))


def _times(box: tuple[int, int, int, int], step: int) -> tuple[int, int, int, int]:
    left, top, width, height = box
    return left * step, top * step, width * step, height * step


def _box(artwork: Artwork, layer: ArtLayer) -> tuple[int, int, int, int] | None:
    """Left, top, width and height of what is drawn on the canvas, with a margin; None where nothing is."""
    left, top, right, bottom = layer.box
    x0, y0, x1, y1 = max(left, 0), max(top, 0), min(right, artwork.width), min(bottom, artwork.height)
    if x1 <= x0 or y1 <= y0 or layer.opacity <= 0:
        return None
    alpha = layer.pixels[y0 - top : y1 - top, x0 - left : x1 - left, 3]
    x, y, across, down = cv2.boundingRect((alpha > 0).astype(np.uint8))
    if not across:
        return None
    return x0 + x - MARGIN, y0 + y - MARGIN, across + 2 * MARGIN, down + 2 * MARGIN


def _picture(
    artwork: Artwork, index: int, box: tuple[int, int, int, int], scale: float, *, blend: Blend | None
) -> LayerPicture:
    layer = artwork.layers[index]
    pixels = _cut(layer, box)
    if blend is None:
        inside = slice(MARGIN, -MARGIN)
        pixels[inside, inside, :3], blend = _laid_over(artwork, index, box), "normal"
    pixels[..., 3] = np.rint(pixels[..., 3] * np.float32(layer.opacity)).astype(np.uint8)
    if scale < 1:
        pixels = _scaled(pixels, max(1, round(box[2] * scale)), max(1, round(box[3] * scale)))
    return LayerPicture(index, pixels, box, blend)


def _cut(layer: ArtLayer, box: tuple[int, int, int, int]) -> NDArray[np.uint8]:
    """The pixels of a layer in a box, transparent outside of the layer and around the margin, uint8."""
    left, top, width, height = box
    cut = np.zeros((height, width, 4), dtype=np.uint8)
    x0, y0 = max(left + MARGIN, layer.left), max(top + MARGIN, layer.top)
    x1, y1 = left + width - MARGIN, top + height - MARGIN
    pixels = layer.pixels[y0 - layer.top : y1 - layer.top, x0 - layer.left : x1 - layer.left]
    if pixels.dtype != np.uint8:
        pixels = np.rint(pixels / np.float32(257)).astype(np.uint8)
    cut[y0 - top : y0 - top + pixels.shape[0], x0 - left : x0 - left + pixels.shape[1]] = pixels
    return cut


def _laid_over(artwork: Artwork, index: int, box: tuple[int, int, int, int]) -> NDArray[np.uint8]:
    """The colours that a layer gives at full opacity over what is below it, uint8, shape [h, w, 3] without margin."""
    from .artwork import flattened

    left, top, width, height = box[0] + MARGIN, box[1] + MARGIN, box[2] - 2 * MARGIN, box[3] - 2 * MARGIN
    below = tuple(
        replace(layer, left=layer.left - left, top=layer.top - top) for layer in artwork.layers[:index] if layer.visible
    )
    layer = artwork.layers[index]
    dense = layer.pixels.copy()
    dense[..., 3] = np.where(dense[..., 3] > 0, np.iinfo(dense.dtype).max, 0)
    own = replace(layer, pixels=dense, left=layer.left - left, top=layer.top - top, opacity=1.0)
    flat = flattened(replace(artwork, width=width, height=height, layers=(*below, own)))[..., :3]
    return flat if flat.dtype == np.uint8 else np.rint(flat / np.float32(257)).astype(np.uint8)


def _scaled(pixels: NDArray[np.uint8], width: int, height: int) -> NDArray[np.uint8]:
    """Straight RGBA at another size; transparent pixels lend no colour."""
    alpha = pixels[..., 3:].astype(np.float32)
    dense = np.concatenate([pixels[..., :3] * (alpha / 255), alpha], axis=2)
    small = cv2.resize(dense, (width, height), interpolation=cv2.INTER_AREA)
    colour = small[..., :3] / np.maximum(small[..., 3:], 1e-3) * 255
    return np.rint(np.clip(np.concatenate([colour, small[..., 3:]], axis=2), 0, 255)).astype(np.uint8)
