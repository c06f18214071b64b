"""Layered artwork: read from PSD, OpenRaster, folders and ComfyUI's layers, blended, flattened, named, and written."""

from __future__ import annotations

from .artwork import ArtLayer, Artwork, Blend
from .blending import lay_over, planes_of
from .flattening import flattened, laid_together
from .layers_dictionary import MOST_LAYERS, from_layers_dictionary, to_layers_dictionary
from .limits import MAX_LAYER_BYTES
from .loading import is_artwork_file, load_artwork
from .naming import LayerPlan, Rule, moving_layers, rule_of
from .ordering import in_order
from .png_layers import trimmed
from .png_writing import check_layer_folder, layer_on_canvas, png_names, save_layer_pngs
from .psd import read_psd
from .psd_writing import check_psd_output, save_psd
from .see_through import from_see_through

__all__ = [
    "MAX_LAYER_BYTES",
    "MOST_LAYERS",
    "ArtLayer",
    "Artwork",
    "Blend",
    "LayerPlan",
    "Rule",
    "check_layer_folder",
    "check_psd_output",
    "flattened",
    "from_layers_dictionary",
    "from_see_through",
    "in_order",
    "is_artwork_file",
    "laid_together",
    "lay_over",
    "layer_on_canvas",
    "load_artwork",
    "moving_layers",
    "planes_of",
    "png_names",
    "read_psd",
    "rule_of",
    "save_layer_pngs",
    "save_psd",
    "to_layers_dictionary",
    "trimmed",
]
