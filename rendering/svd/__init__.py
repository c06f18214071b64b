"""Stable Video Diffusion led by sketches, the paper's renderer for the public LVCD weights, or by an animation."""

from __future__ import annotations

from .configuration import NetworkConfiguration
from .crude_animation import CrudeAnimation
from .frame_layout import CLIP_FRAMES, FrameLayout
from .options import SVDOptions

__all__ = [
    "CLIP_FRAMES",
    "CrudeAnimation",
    "FrameLayout",
    "NetworkConfiguration",
    "SVDOptions",
]
