"""Bounds of layered files: what lies beyond them is a slip or a hostile file."""

from __future__ import annotations

from collections.abc import Iterable

from ...physics.errors import InvalidInputError
from ...physics.limits import MAX_PICTURE_PIXELS, MAX_PICTURE_SIDE

__all__ = ["MAX_FILE_BYTES", "MAX_LAYERS", "MAX_LAYER_BYTES", "check_canvas", "check_layer_sizes"]

MAX_LAYERS = 1_000
"""Layers of one artwork, groups not counted."""

MAX_LAYER_BYTES = 2**31
"""Pixels of all layers together in memory [bytes], 4 bytes each with 8 bits a channel, 8 with 16: with 8 bits, that is
8 full layers of 8192 x 8192, or 240 of 1920 x 1080."""

MAX_FILE_BYTES = 2**31
"""Size of a layered file [bytes]; it is in memory as a whole while a PSD is read."""


def check_canvas(width: int, height: int, name: str) -> None:
    """Raise unless a canvas of this size [px] can be drawn.

    Raises:
        InvalidInputError: it is empty or too large.
    """
    if not (0 < width <= MAX_PICTURE_SIDE and 0 < height <= MAX_PICTURE_SIDE and width * height <= MAX_PICTURE_PIXELS):
        raise InvalidInputError(
            f"{name} must have from 1 to {MAX_PICTURE_PIXELS / 1e6:.0f} million pixels (such as 8192 x 8192) and at"
            f" most {MAX_PICTURE_SIDE} px on a side. Got: {width} x {height} px"
        )


def check_layer_sizes(sizes: Iterable[tuple[str, int, int]], sample_bytes: int, name: str) -> None:
    """Raise unless layers of these sizes may be decoded together.

    Args:
        sizes: name, width and height [px] of each layer.
        sample_bytes: of one channel of one pixel: 1 or 2.
        name: what the user calls the artwork.

    Raises:
        InvalidInputError: there are too many, one is too large, or all together are.
    """
    total = 0
    for count, (layer, width, height) in enumerate(sizes):
        if count >= MAX_LAYERS:
            raise InvalidInputError(f"{name} must have at most {MAX_LAYERS} layers. Got: more")
        if width > 0 and height > 0:
            check_canvas(width, height, f"{name}: layer {layer}")
            total += width * height * 4 * sample_bytes
    if total > MAX_LAYER_BYTES:
        raise InvalidInputError(
            f"{name} must need at most {MAX_LAYER_BYTES / 2**30:.0f} GiB for its layers; make the picture smaller, or"
            f" trim or merge layers that stand still. Got: {total / 2**30:.1f} GiB"
        )
