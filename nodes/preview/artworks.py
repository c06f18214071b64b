"""Layered files as the editor shows them before their node has run."""

from __future__ import annotations

from ..host import place_of
from .plates import png_of

__all__ = ["flattened_png"]


def flattened_png(name: str) -> bytes:
    """The visible layers of a file of the input folder, laid over one another, as a PNG file.

    Args:
        name: of a layered file, or of a folder of layers.

    Raises:
        InvalidInputError: it leads out of the input folder, or cannot be read.
    """
    from ...rendering.artwork import flattened, load_artwork
    from ...rendering.pictures import as_uint8

    return png_of(as_uint8(flattened(load_artwork(place_of(name)))))
