"""Where the layers of an artwork are, and what stands still before them."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox

if TYPE_CHECKING:
    from ..artwork import ArtLayer, Artwork

__all__ = ["hidden_by", "mask_of_layer", "resting_on"]

FloatImage = NDArray[np.float32]

_HALF = 0.5
# A mask is as wide as what this share of the layer's paint is at least half as dense as.
_PAINT = 0.9
_BACKDROP = 0.8  # a layer that fills this share of the canvas is what all stands before


def mask_of_layer(artwork: Artwork, index: int) -> FloatImage:
    """Where a layer is, hidden places included, 0 to 1, shape [h, w].

    Of translucent paint the mask is denser than the paint: it is 1/2 where the alpha is half of what nine tenths of
    all paint reaches, so that a veil counts as what it is in spite of a few opaque pixels, and an opaque shape is as
    wide as ever in spite of its soft edge.
    """
    mask = _alpha(artwork, index)
    dense = _density(mask)
    return np.minimum(mask / np.float32(dense), 1, dtype=np.float32) if 0 < dense < 1 else mask


def _density(alpha: FloatImage) -> float:
    """The alpha that most of the paint reaches; 1 where nothing is."""
    counts, edges = np.histogram(alpha[alpha > 0], bins=256, range=(0, 1))
    paint = counts * (edges[:-1] + edges[1:])
    if not paint.any():
        return 1.0
    faint = np.searchsorted(np.cumsum(paint), (1 - _PAINT) * paint.sum())
    return float(edges[faint]) if faint < len(counts) - 1 else 1.0


def hidden_by(artwork: Artwork, index: int, *, moving: Collection[int]) -> NDArray[np.bool_] | None:
    """Where layers that stand still hide a layer, shape [h, w]; None for nowhere.

    Args:
        artwork: the layers.
        index: of the layer behind.
        moving: indices of all layers that move.
    """
    cover = np.zeros((artwork.height, artwork.width), dtype=bool)
    for number in range(index + 1, len(artwork.layers)):
        layer = artwork.layers[number]
        if number not in moving and layer.visible and layer.blend == "normal" and layer.opacity >= _HALF:
            cover |= _alpha(artwork, number) * np.float32(layer.opacity) >= _HALF
    return cover if cover.any() else None


def resting_on(artwork: Artwork, index: int, *, moving: Collection[int]) -> NDArray[np.bool_] | None:
    """Where layers that stand still are behind a layer, backdrops apart, shape [h, w]; None for nowhere.

    Args:
        artwork: the layers.
        index: of the layer in front.
        moving: indices of all layers that move.
    """
    behind = np.zeros((artwork.height, artwork.width), dtype=bool)
    for number in range(index):
        layer = artwork.layers[number]
        if not _share_a_pixel(layer, artwork.layers[index]):
            continue
        if number not in moving and layer.visible and layer.blend == "normal" and layer.opacity >= _HALF:
            shape = _alpha(artwork, number) >= _HALF
            behind |= shape & (shape.mean() < _BACKDROP)
    return behind if behind.any() else None


def _share_a_pixel(one: ArtLayer, other: ArtLayer) -> bool:
    """Whether the boxes of two layers overlap."""
    left, top, right, bottom = (
        max(one.box[0], other.box[0]),
        max(one.box[1], other.box[1]),
        min(one.box[2], other.box[2]),
        min(one.box[3], other.box[3]),
    )
    return left < right and top < bottom


def _alpha(artwork: Artwork, index: int) -> FloatImage:
    """Alpha of a layer's pixels over the canvas, without its opacity, shape [h, w]."""
    layer = artwork.layers[index]
    alpha = np.zeros((artwork.height, artwork.width), dtype=np.float32)
    left, top, right, bottom = layer.box
    box = PixelBox(left, top, right, bottom).clipped(artwork.width, artwork.height)
    if box.width and box.height:
        part = layer.pixels[box.top - top : box.bottom - top, box.left - left : box.right - left, 3]
        alpha[box.slices] = part.astype(np.float32) / np.float32(np.iinfo(part.dtype).max)
    return alpha
