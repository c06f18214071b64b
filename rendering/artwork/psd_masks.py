"""Masks of layers and groups of a PSD file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .artwork import ArtLayer
from .groups import masked
from .limits import check_canvas
from .psd_pixels import plane_of

if TYPE_CHECKING:
    from psd_tools.api.layers import Layer

__all__ = ["with_masks"]

_MASK, _BOTH_MASKS = -2, -3
"""Numbers of the channels of a painted mask, and of a painted and a drawn one together."""


def with_masks(layer: ArtLayer, source: Layer, remarks: list[str]) -> ArtLayer:
    """A layer with the masks of the file's layer or group applied.

    Args:
        layer: the layer so far.
        source: whose masks they are: its own, or those of a group that it is in.
        remarks: gets a sentence where a mask cannot be applied.

    Raises:
        InvalidInputError: a mask is damaged or too large.
    """
    if not layer.pixels.size:
        return layer
    both = source.mask is not None and source.mask.has_real() and _BOTH_MASKS in _channels(source)
    if source.mask is not None and not source.mask.disabled:
        layer = _with_painted(layer, source, _BOTH_MASKS if both else _MASK)
    if not both and source.has_vector_mask() and not _drawn_already(source):
        layer = _with_drawn(layer, source, remarks)
    return layer


def _drawn_already(source: Any) -> bool:
    """Whether the file holds what a mask of paths does as pixels, too: in those of a shape, or as a painted mask."""
    if source.kind == "shape" and source.has_pixels():
        return True
    return (
        source.mask is not None and not source.mask.disabled and _is_drawn(source.mask) and _MASK in _channels(source)
    )


def _is_drawn(mask: Any) -> bool:
    """Whether a painted mask is a mask of paths as pixels."""
    return bool(mask.flags.user_mask_from_render)


def _channels(source: Any) -> set[int]:
    return {info.id for info in source._record.channel_info}


def _with_painted(layer: ArtLayer, source: Any, channel: int) -> ArtLayer:
    mask = source.mask
    if channel not in _channels(source):
        return layer
    left, top, right, bottom = mask.bbox if channel == _BOTH_MASKS else _painted_box(mask)
    outside = (mask.background_color if channel == _BOTH_MASKS else mask.data.background_color) / 255
    width, height = right - left, bottom - top
    if width > 0 and height > 0:
        check_canvas(width, height, f"layer {source.name}: mask")
        plane = plane_of(source, channel, width, height)
        values = plane.astype(np.float32) / np.float32(np.iinfo(plane.dtype).max)
    else:
        values = np.zeros((0, 0), np.float32)
    density = _density(mask, drawn=_is_drawn(mask))
    # The pixels of a shape have its soft edge already; a mask that repeats it must not count twice.
    repeats = _is_drawn(mask) and source.kind == "shape"
    return masked(layer, 1 - density * (1 - values), left, top, 1 - density * (1 - outside), at_most=repeats)


def _painted_box(mask: Any) -> tuple[int, int, int, int]:
    data = mask.data
    return data.left, data.top, data.right, data.bottom


def _density(mask: Any, *, drawn: bool) -> float:
    """How much the painted mask, or the one of paths, counts, 0 to 1."""
    parameters = None if mask is None else mask.parameters
    if parameters is None:
        return 1.0
    density = parameters.vector_mask_density if drawn else parameters.user_mask_density
    return 1.0 if density is None else density / 255


def _with_drawn(layer: ArtLayer, source: Any, remarks: list[str]) -> ArtLayer:
    """With a mask that is given by paths."""
    if source.vector_mask is None or source.vector_mask.disabled:
        return layer
    try:
        from psd_tools.composite.vector import draw_vector_mask

        coverage = draw_vector_mask(source, viewport=layer.box)
    except ImportError:  # psd-tools of Python 3.10 draws paths with another package
        remarks.append(f"layer {source.name}: its vector mask is not applied; rasterise it in the painting program")
        return layer
    density = _density(source.mask, drawn=True)
    return masked(layer, 1 - density * (1 - np.asarray(coverage, np.float32)[..., 0]), layer.left, layer.top, 0.0)
