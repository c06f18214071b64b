"""Frames without a network: the illustration cut into layers, each bent by its body's motion over the clean plate."""

from __future__ import annotations

from .apron import ApronedMesh, canvas_of
from .artwork_layers import hidden_by, mask_of_layer, resting_on
from .background import Background, background_of, renderer_of, shown_frame, shown_frame_and_alpha, usual_background
from .beyond_border import on_canvas
from .layer import Layer
from .layered_renderer import LayeredRenderer
from .pixel_art import PixelArtRenderer
from .pixel_blocks import pixel_art_hint
from .sprite_layers import sprite_plate
from .still_layers import behind_still
from .still_parts import keep_still_parts, moving_region

__all__ = [
    "ApronedMesh",
    "Background",
    "Layer",
    "LayeredRenderer",
    "PixelArtRenderer",
    "background_of",
    "behind_still",
    "canvas_of",
    "hidden_by",
    "keep_still_parts",
    "mask_of_layer",
    "moving_region",
    "on_canvas",
    "pixel_art_hint",
    "renderer_of",
    "resting_on",
    "shown_frame",
    "shown_frame_and_alpha",
    "sprite_plate",
    "usual_background",
]
