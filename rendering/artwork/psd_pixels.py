"""The pixels of one layer of a PSD file."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError

if TYPE_CHECKING:
    from psd_tools.api.layers import Layer

__all__ = ["COLOURED", "pixels_of", "plane_of"]

COLOURED = ("solidcolorfill", "shape")
"""Kinds of layers that have the size of the canvas where the file says no more than their colour."""

_ALPHA = -1
"""Number of the channel of a layer's alpha; the colours begin with 0."""


def pixels_of(layer: Layer) -> NDArray[Any] | None:
    """Straight RGBA of a layer, uint8 or uint16, shape [h, w, 4]; None where it is of a kind that has none.

    A fill, and a shape without pixels, has the size of the canvas; masks make it smaller.

    Raises:
        InvalidInputError: the layer is damaged.
    """
    dtype = np.dtype(np.uint8 if layer._psd.depth == 8 else np.uint16)
    if layer.kind in COLOURED and not layer.has_pixels():
        return _one_colour(layer, dtype)
    if layer.kind not in ("pixel", "type", "smartobject") and not layer.has_pixels():
        return None
    width, height = max(layer.width, 0), max(layer.height, 0)
    result = np.full((height, width, 4), np.iinfo(dtype).max, dtype)
    if not result.size:
        return result
    channels = {info.id for info in layer._record.channel_info}
    for index in range(3):
        source = index if index in channels else 0  # greyscale has one
        if source in channels:
            result[..., index] = plane_of(layer, source, width, height)
    if _ALPHA in channels:
        result[..., 3] = plane_of(layer, _ALPHA, width, height)
    return result


def plane_of(layer: Layer, channel: int, width: int, height: int) -> NDArray[Any]:
    """One channel of a layer, uint8 or uint16, shape [h, w].

    Raises:
        InvalidInputError: the channel is damaged.
    """
    from psd_tools.compression import PSDDecompressionWarning

    depth = layer._psd.depth
    dtype = np.dtype(">u1" if depth == 8 else ">u2")
    data = next(
        data for info, data in zip(layer._record.channel_info, layer._channels, strict=False) if info.id == channel
    )
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("error", category=PSDDecompressionWarning)  # psd-tools would go on with black
            decoded = data.get_data(width, height, depth, layer._psd.version)
    except (ValueError, OSError, IndexError, Warning) as error:
        raise InvalidInputError(f"layer {layer.name} cannot be read: it is damaged") from error
    if len(decoded) != width * height * dtype.itemsize:
        raise InvalidInputError(f"layer {layer.name} cannot be read: it is cut off")
    return np.frombuffer(decoded, dtype).reshape(height, width)


def _one_colour(layer: Any, dtype: np.dtype[Any]) -> NDArray[Any] | None:
    """A layer of the canvas' size in the colour of a fill or shape; None where that is not given as RGB or grey."""
    from psd_tools.constants import Tag

    fill = layer.tagged_blocks.get_data(Tag.SOLID_COLOR_SHEET_SETTING)
    parts = None if fill is None else fill.get(b"Clr ")
    if parts is None:
        return None
    described = {bytes(key).strip(): float(value) for key, value in parts.items() if _number(value)}
    grey = described.get(b"Gry")
    if grey is not None:
        colour = [255 * (1 - grey / 100)] * 3
    elif {b"Rd", b"Grn", b"Bl"} <= described.keys():
        colour = [described[key] for key in (b"Rd", b"Grn", b"Bl")]
    else:
        return None
    most = np.iinfo(dtype).max
    result = np.full((layer._psd.height, layer._psd.width, 4), most, dtype)
    result[..., :3] = np.rint(np.clip(np.array(colour) / 255, 0, 1) * most).astype(dtype)
    return result


def _number(value: Any) -> bool:
    try:
        return bool(np.isfinite(float(value)))
    except (TypeError, ValueError):
        return False
