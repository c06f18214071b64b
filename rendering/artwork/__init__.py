"""Layered artwork: read from PSD, OpenRaster, folders and ComfyUI's layers, blended, flattened, named, and written."""

from __future__ import annotations

from .artwork import ArtLayer, Artwork, Blend
from .blending import lay_over, planes_of
from .flattening import flattened, laid_together
from .limits import MAX_LAYER_BYTES, MAX_LAYERS
from .loading import is_artwork_file, load_artwork
from .psd import read_psd

__all__ = [
    "MAX_LAYERS",
    "MAX_LAYER_BYTES",
    "ArtLayer",
    "Artwork",
    "Blend",
    "flattened",
    "is_artwork_file",
    "laid_together",
    "lay_over",
    "load_artwork",
    "planes_of",
    "read_psd",
]
