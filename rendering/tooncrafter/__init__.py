"""Cartoon interpolation between two keyframes with sketch control (ToonCrafter, Xing et al. 2024)."""

from __future__ import annotations

from .configuration import (
    AutoencoderConfiguration,
    ResamplerConfiguration,
    SketchEncoderConfiguration,
    UNetConfiguration,
)
from .options import SOLVERS, ToonCrafterOptions

__all__ = [
    "SOLVERS",
    "AutoencoderConfiguration",
    "ResamplerConfiguration",
    "SketchEncoderConfiguration",
    "ToonCrafterOptions",
    "UNetConfiguration",
]
