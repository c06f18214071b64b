"""ComfyUI's own ``LAYERS``: a dictionary of pictures with their places, read and written.

Source: ``comfy_api.latest.io.Layers`` and ``comfy_extras/nodes_compositor.py`` of ComfyUI 0.31 and later.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.arrays import as_array
from ...physics.errors import InvalidInputError, require, shown
from .artwork import ArtLayer, Artwork, Blend
from .limits import MAX_OFFSET, MemoryCount, check_canvas
from .placement import Placement, placed
from .png_layers import as_one_dtype, trimmed

__all__ = ["MOST_LAYERS", "from_layers_dictionary", "to_layers_dictionary"]

MOST_LAYERS = 50
"""Layers that ComfyUI's own compositor takes."""

_BLENDS: dict[str, Blend] = {
    "normal": "normal",
    "multiply": "multiply",
    "screen": "screen",
    "overlay": "overlay",
    "linear-dodge": "add",
}


def from_layers_dictionary(document: Any) -> Artwork:
    """Layers of ComfyUI's as artwork.

    Args:
        document: ``{"version": 1, "canvas": (w, h), "layers": [...]}``; one is ``{"image": [b, h, w, 3 or 4] in 0
            to 1, "mask": [b, h, w] with 1 where transparent, "name", "x", "y", "w", "h", "opacity", "blend_mode",
            "visible", "rotation" [rad, clockwise], "flip_h", "flip_v", "z_index"}``, all but the image optional. Each
            picture of a batch is a layer. Without a canvas, it is as large as what is placed on it.

    Raises:
        InvalidInputError: it is no such dictionary, or a value is out of range.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import from_layers_dictionary
        >>> grey = {"image": np.full((1, 2, 3, 3), 0.4, np.float32), "x": 1, "name": "paper"}
        >>> artwork = from_layers_dictionary({"version": 1, "layers": [grey]})
        >>> artwork.width, artwork.height, artwork.layers[0].pixels[0, 0].tolist()
        (4, 2, [102, 102, 102, 255])
    """
    if not isinstance(document, dict) or not isinstance(document.get("layers"), list | tuple):
        raise InvalidInputError(f"layers must be a dictionary with a list of layers. Got: {shown(document)}")
    require("layers: version", document.get("version", 1), document.get("version", 1) in (1, None), "1")
    items = [item for item in document["layers"] if isinstance(item, dict)]
    items.sort(key=lambda item: _whole(item, "z_index"))
    count = MemoryCount("layers")
    layers: list[ArtLayer] = []
    remarks: list[str] = []
    for number, item in enumerate(items, 1):
        for layer in _layers_of(item, f"layer {number}", remarks):
            layer = trimmed(layer)
            count.add(layer.pixels.nbytes)
            layers.append(layer)
    width, height = _canvas(document, items)
    return Artwork(width, height, as_one_dtype(layers), tuple(remarks))


def _canvas(document: dict[str, Any], items: list[dict[str, Any]]) -> tuple[int, int]:
    given = document.get("canvas")
    if given is None:
        boxes = [_placement(item, _size(item)).box for item in items]
        given = max([1, *[box[2] for box in boxes]]), max([1, *[box[3] for box in boxes]])
    right = isinstance(given, list | tuple) and len(given) == 2 and all(_is_whole(each) for each in given)
    require("layers: canvas", given, right, "a width and a height [px]")
    check_canvas(int(given[0]), int(given[1]), "layers: canvas")
    return int(given[0]), int(given[1])


def _layers_of(item: dict[str, Any], usual: str, remarks: list[str]) -> Iterator[ArtLayer]:
    """A layer for each picture of a batch."""
    kind = item.get("type", "raster")
    require(f"{usual}: type", kind, kind == "raster", "raster")
    name = str(item.get("name") or usual)
    batch = _batch(item, name)
    masks = None if item.get("mask") is None else as_array(item["mask"], f"{name}: mask")
    if masks is not None and (masks.ndim != 3 or not masks.size):
        raise InvalidInputError(f"layer {name}: mask must have shape [b, h, w]. Got: {masks.shape}")
    blend = item.get("blend_mode") or "normal"
    if blend not in _BLENDS:
        remarks.append(f"layer {name}: blend mode {shown(blend)} is drawn as normal")
    placement = _placement(item, (batch.shape[2], batch.shape[1]))
    for index in range(len(batch)):
        pixels = _pixels(batch[index], _mask_at(masks, index), name)
        yield placed(
            ArtLayer(
                name=name if len(batch) == 1 else f"{name} {index + 1}",
                pixels=pixels,
                opacity=_share(item, name),
                blend=_BLENDS.get(blend, "normal"),
                visible=bool(item.get("visible", True)),
            ),
            placement,
        )


def _batch(item: dict[str, Any], name: str) -> NDArray[Any]:
    batch = as_array(item.get("image"), f"layer {name}: image")
    if batch.ndim != 4 or batch.shape[3] not in (3, 4) or not batch.size:
        raise InvalidInputError(f"layer {name}: image must have shape [b, h, w, 3 or 4]. Got: {batch.shape}")
    check_canvas(batch.shape[2], batch.shape[1], f"layer {name}: image")
    return batch


def _size(item: dict[str, Any]) -> tuple[int, int]:
    batch = _batch(item, str(item.get("name") or "image"))
    return batch.shape[2], batch.shape[1]


def _mask_at(masks: NDArray[Any] | None, index: int) -> NDArray[Any] | None:
    """The mask of one picture of a batch: one for all, or each its own; pictures beyond the masks have none."""
    if masks is None or (len(masks) > 1 and index >= len(masks)):
        return None
    return masks[0 if len(masks) == 1 else index]


def _pixels(image: NDArray[Any], mask: NDArray[Any] | None, name: str) -> NDArray[Any]:
    """Straight RGBA of a picture: 8 bits if that is exact, otherwise 16."""
    import cv2

    values = np.ones((*image.shape[:2], 4), np.float32)
    values[..., : image.shape[2]] = image
    if mask is not None:
        there = mask.astype(np.float32)
        if there.shape != values.shape[:2]:
            there = cv2.resize(there, (values.shape[1], values.shape[0]), interpolation=cv2.INTER_LINEAR)
        values[..., 3] *= 1 - np.clip(there, 0, 1)
    if not np.isfinite(values).all():
        raise InvalidInputError(f"layer {name}: image must hold finite numbers. Got: NaN or infinity")
    np.clip(values, 0, 1, out=values)
    levels = values * 255
    whole = np.rint(levels)
    if np.abs(levels - whole).max() < 1e-3:
        return whole.astype(np.uint8)
    return np.rint(values * 65535).astype(np.uint16)


def _placement(item: dict[str, Any], size: tuple[int, int]) -> Placement:
    width, height = (_whole(item, key) for key in ("w", "h"))
    angle = item.get("rotation") or 0.0
    right = isinstance(angle, int | float) and not isinstance(angle, bool) and abs(angle) < 1e6
    require("layer: rotation", angle, right, "an angle [rad]")
    placement = Placement(
        left=_whole(item, "x"),
        top=_whole(item, "y"),
        width=width if width > 0 else size[0],
        height=height if height > 0 else size[1],
        angle=float(angle),
        flipped=bool(item.get("flip_h", False)),
        upside_down=bool(item.get("flip_v", False)),
    )
    left, top, right_edge, bottom = placement.box
    check_canvas(right_edge - left, bottom - top, "layer: what is placed")
    return placement


def _whole(item: dict[str, Any], key: str) -> int:
    value = item.get(key)
    value = 0 if value is None else value
    require(f"layer: {key}", value, _is_whole(value) and abs(value) <= MAX_OFFSET, f"a number of at most {MAX_OFFSET}")
    return int(value)


def _is_whole(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < float("inf")


def _share(item: dict[str, Any], name: str) -> float:
    value = item.get("opacity")
    value = 1.0 if value is None else value
    require(f"layer {name}: opacity", value, _is_whole(value), "a number from 0 to 1")
    return min(max(float(value), 0.0), 1.0)


def to_layers_dictionary(artwork: Artwork, *, most: int | None = MOST_LAYERS) -> dict[str, Any]:
    """Artwork as ComfyUI's ``LAYERS``; empty layers are left out.

    All have the same ``z_index``: their order in the list counts, and what ComfyUI's own nodes add comes to lie on top.

    Args:
        artwork: the layers.
        most: how many layers there may be; None for any number, which only ComfyUI's own compositor does not take.

    Raises:
        InvalidInputError: there are more layers.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import ArtLayer, Artwork, to_layers_dictionary
        >>> hair = ArtLayer("hair", np.full((2, 3, 4), 255, np.uint8), left=-1)
        >>> document = to_layers_dictionary(Artwork(8, 6, (hair,)))
        >>> document["canvas"], tuple(document["layers"][0]["image"].shape), document["layers"][0]["x"]
        ((8, 6), (1, 2, 3, 4), -1)
    """
    import torch

    modes = {ours: theirs for theirs, ours in _BLENDS.items()}
    layers = [(name, layer) for name, layer in zip(artwork.names, artwork.layers, strict=True) if layer.pixels.size]
    if most is not None:
        require("layers", len(layers), len(layers) <= most, f"at most {most}, which is what ComfyUI takes")
    return {
        "version": 1,
        "canvas": (artwork.width, artwork.height),
        "layers": [
            {
                "type": "raster",
                "image": torch.from_numpy(layer.pixels.astype(np.float32) / np.float32(_most(layer)))[None],
                "name": name,
                "x": layer.left,
                "y": layer.top,
                "z_index": 0,
                "opacity": float(layer.opacity),
                "blend_mode": modes[layer.blend],
                "visible": layer.visible,
            }
            for name, layer in layers
        ],
    }


def _most(layer: ArtLayer) -> int:
    return int(np.iinfo(layer.pixels.dtype).max)
