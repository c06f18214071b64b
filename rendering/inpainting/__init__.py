"""Soft inpainting: what a motion has uncovered is painted by a diffusion model, the more the nearer to the hole."""

from __future__ import annotations

from .change_maps import change_map
from .options import InpaintingOptions

__all__ = [
    "InpaintingOptions",
    "change_map",
]
