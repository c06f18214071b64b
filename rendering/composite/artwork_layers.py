"""Layered artwork as the renderer draws it: what moves with its own pixels, and what stands still flattened in runs.

Runs of still layers between two moving ones are laid over one another once. Pixels of a moving layer that its mesh does
not reach, specks and faint glows, stand still just behind it, so that at rest the artwork is whole.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, TriangleMesh
from ..artwork import ArtLayer, Artwork, Blend, planes_of
from ..artwork import lay_over as blended
from ..pictures import straight
from .cutting import Layer, covered_by
from .laying import lay_over
from .still_layers import StillLayer, still_layer

__all__ = ["bent", "hidden_by", "layers_of", "mask_of_layer", "resting_on", "texture_over"]

FloatImage = NDArray[np.float32]

_OPAQUE = 1 - 0.5 / 255
_HALF = 0.5
_BACKDROP = 0.8  # a layer that fills this share of the canvas is what all stands before


def layers_of(
    artwork: Artwork, meshes: Mapping[int, TriangleMesh]
) -> tuple[FloatImage, list[Layer | StillLayer], list[int | None]]:
    """The background and the layers over it, from back to front.

    Args:
        artwork: the layers; hidden ones are left out unless they move.
        meshes: mesh of each layer that moves, by its index.

    Returns:
        What stands still behind all that moves, in 0 to 1: RGB where it is opaque, shape [h, w, 3], else premultiplied
        RGBA, shape [h, w, 4]; the layers over it; and for each the index of the layer that moves of which it is a part,
        None where it is of none.
    """
    whole = PixelBox(0, 0, artwork.width, artwork.height)
    planes = np.zeros((artwork.height, artwork.width, 4), dtype=np.float32)
    pieces, run = _Pieces(), None
    for index, layer in enumerate(artwork.layers):
        if index in meshes:
            pieces.add(run)
            moving, left_over = _moving(layer, meshes[index], whole)
            pieces.add(left_over, layer.blend, index)
            pieces.layers.append(moving)
            pieces.sources.append(index)
            run = None
        elif layer.visible and layer.opacity > 0:
            texture = texture_over(layer, whole)
            if not any(isinstance(each, Layer) for each in pieces.layers):
                blended(planes, texture, layer.blend)
            elif layer.blend == "normal":
                run = np.zeros_like(planes) if run is None else run
                blended(run, texture)
            else:
                pieces.add(run)
                pieces.add(texture, layer.blend)
                run = None
    pieces.add(run)
    return (planes[..., :3] if planes[..., 3].min() >= _OPAQUE else planes), pieces.layers, pieces.sources


class _Pieces:
    """Layers from back to front, and of which moving layer each is a part."""

    def __init__(self) -> None:
        self.layers: list[Layer | StillLayer] = []
        self.sources: list[int | None] = []

    def add(self, texture: FloatImage | None, blend: Blend = "normal", source: int | None = None) -> None:
        """One that stands still, of a texture of the canvas' size; nothing where it is empty."""
        layer = None if texture is None else still_layer(texture, blend)
        if layer is not None:
            self.layers.append(layer)
            self.sources.append(source)


def bent(layer: ArtLayer, pieces: Sequence[tuple[PixelBox, FloatImage]], width: int, height: int) -> ArtLayer:
    """A layer as it is in one frame, of pieces laid over one another, cut to where it shows.

    Args:
        layer: at rest.
        pieces: boxes of the canvas and premultiplied RGBA there, from back to front.
        width: of the canvas [px].
        height: of the canvas [px].
    """
    planes = np.zeros((4, height, width), dtype=np.float32)
    for box, texture in pieces:
        rows, columns = box.slices
        lay_over(planes[:, rows, columns], texture)
    left, top, across, down = cv2.boundingRect((planes[3] > 0).astype(np.uint8))
    shown = straight(np.ascontiguousarray(np.moveaxis(planes, 0, 2)[top : top + down, left : left + across]))
    kind = layer.pixels.dtype
    pixels = np.rint(shown * np.float32(np.iinfo(kind).max)).astype(kind)
    return replace(layer, pixels=pixels, left=left, top=top, opacity=1.0, visible=True)


def mask_of_layer(artwork: Artwork, index: int) -> FloatImage:
    """Where a layer is, hidden places included, 0 to 1, shape [h, w]; of a translucent one 1 where it is densest."""
    mask = _alpha(artwork, index)
    densest = float(mask.max(initial=0))
    return mask / np.float32(densest) if 0 < densest < 1 else mask


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
        if number not in moving and layer.visible and layer.blend == "normal" and layer.opacity >= _HALF:
            shape = _alpha(artwork, number) >= _HALF
            behind |= shape & (shape.mean() < _BACKDROP)
    return behind if behind.any() else None


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


def texture_over(layer: ArtLayer, box: PixelBox) -> FloatImage:
    """Premultiplied RGBA of a layer over a box of the canvas, with its opacity, shape [box height, box width, 4]."""
    texture = np.zeros((box.height, box.width, 4), dtype=np.float32)
    own_left, own_top, own_right, own_bottom = layer.box
    left, top = max(box.left, own_left), max(box.top, own_top)
    right, bottom = min(box.right, own_right), min(box.bottom, own_bottom)
    if right <= left or bottom <= top:
        return texture
    pixels = layer.pixels[top - layer.top : bottom - layer.top, left - layer.left : right - layer.left]
    shown = slice(top - box.top, bottom - box.top), slice(left - box.left, right - box.left)
    texture[shown] = planes_of(pixels, layer.opacity)
    return texture


def _moving(layer: ArtLayer, mesh: TriangleMesh, whole: PixelBox) -> tuple[Layer, FloatImage]:
    """The layer on its mesh, and what of it the mesh does not reach, premultiplied, shape [h, w, 4]."""
    at_rest = texture_over(layer, whole)
    aproned, canvas, covered = covered_by(mesh, lambda canvas: texture_over(layer, canvas)[..., 3])
    texture = texture_over(layer, canvas)
    left_over = np.where(covered[..., None], np.float32(0), at_rest)
    return Layer(aproned, canvas, texture, layer.blend), left_over
