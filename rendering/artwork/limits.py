"""Bounds of layered files: what lies beyond them is a slip or a hostile file."""

from __future__ import annotations

from collections.abc import Iterable

from ...physics.errors import InvalidInputError
from ...physics.limits import MAX_LAYERS, MAX_PICTURE_PIXELS, MAX_PICTURE_SIDE

__all__ = [
    "MAX_FILE_BYTES",
    "MAX_LAYER_BYTES",
    "MAX_OFFSET",
    "MAX_PICTURE_BYTES",
    "MemoryCount",
    "check_canvas",
    "check_layer_sizes",
]

MAX_LAYER_BYTES = 2**31
"""Pixels of all layers together in memory [bytes], 4 bytes each with 8 bits a channel, 8 with 16: with 8 bits, that is
8 full layers of 8192 x 8192, or 240 of 1920 x 1080."""

MAX_FILE_BYTES = 2**31
"""Size of a layered file [bytes]; it is in memory as a whole while a PSD is read."""

MAX_PICTURE_BYTES = 2**28
"""Size of the file of one layer, where each has its own [bytes]."""

MAX_OFFSET = 10 * MAX_PICTURE_SIDE
"""How far from the canvas a layer may lie [px]."""


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


class MemoryCount:
    """Counts layers and the memory of their pixels while they are read."""

    def __init__(self, name: str) -> None:
        """Begin with none.

        Args:
            name: what the user calls the artwork.
        """
        self._name = name
        self._layers = 0
        self._bytes = 0

    def add(self, size: int) -> None:
        """Count one layer of a size [bytes].

        Raises:
            InvalidInputError: there are too many layers, or all together are too large.
        """
        self._layers += 1
        self._bytes += size
        if self._layers > MAX_LAYERS:
            raise InvalidInputError(f"{self._name} must have at most {MAX_LAYERS} layers. Got: more")
        if self._bytes > MAX_LAYER_BYTES:
            raise InvalidInputError(
                f"{self._name} must need at most {MAX_LAYER_BYTES / 2**30:.0f} GiB for its layers; make the picture"
                " smaller, or trim or merge layers that stand still. Got: more"
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
    count = MemoryCount(name)
    for layer, width, height in sizes:
        if width > 0 and height > 0:
            check_canvas(width, height, f"{name}: layer {layer}")
        count.add(max(width, 0) * max(height, 0) * 4 * sample_bytes)
