"""Frames between keyframes: by optical flow, by the motion itself, or by a network."""

from __future__ import annotations

from .backend import Clip, FloatImage, ModelFile
from .interpolation import BACKENDS, DEFAULT_GAP, interpolate, keyframe_indices

__all__ = [
    "BACKENDS",
    "DEFAULT_GAP",
    "Clip",
    "FloatImage",
    "ModelFile",
    "interpolate",
    "keyframe_indices",
]
