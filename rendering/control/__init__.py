"""Inputs for video models that follow a motion: warped frames with holes, moving lines, sizes and lengths."""

from __future__ import annotations

from .control_video import first_and_last, line_frames, warped_frames
from .model_format import FRAME_STEP, SIZE_STEP, ModelFormat

__all__ = [
    "FRAME_STEP",
    "SIZE_STEP",
    "ModelFormat",
    "first_and_last",
    "line_frames",
    "warped_frames",
]
