"""Inputs for video models that follow a motion: frames with holes, moving lines, crude animations, keyframes, sizes."""

from __future__ import annotations

from .clip_rules import AREAS, TIMINGS, Timing, suitable_length, suitable_size, timed, told_rules
from .control_video import first_and_last, line_frames, warped_frames
from .crude_animation import LATENT_CELL, LatentStep, time_to_move
from .keyframes import known_latents, moments, motion_keyframes, placed_keyframes
from .model_format import FRAME_STEP, SIZE_STEP, ModelFormat, check_length
from .moving_noise import experimental_moving_noise

__all__ = [
    "AREAS",
    "FRAME_STEP",
    "LATENT_CELL",
    "SIZE_STEP",
    "TIMINGS",
    "LatentStep",
    "ModelFormat",
    "Timing",
    "check_length",
    "experimental_moving_noise",
    "first_and_last",
    "known_latents",
    "line_frames",
    "moments",
    "motion_keyframes",
    "placed_keyframes",
    "suitable_length",
    "suitable_size",
    "time_to_move",
    "timed",
    "told_rules",
    "warped_frames",
]
