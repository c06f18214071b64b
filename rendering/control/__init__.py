"""Inputs for video models: warped frames with holes, moving lines, keyframes, sizes and lengths."""

from __future__ import annotations

from .control_video import first_and_last, line_frames, warped_frames
from .keyframes import known_latents, moments, motion_keyframes, placed_keyframes
from .model_format import FRAME_STEP, SIZE_STEP, ModelFormat

__all__ = [
    "FRAME_STEP",
    "SIZE_STEP",
    "ModelFormat",
    "first_and_last",
    "known_latents",
    "line_frames",
    "moments",
    "motion_keyframes",
    "placed_keyframes",
    "warped_frames",
]
