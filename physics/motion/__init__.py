"""What a simulation gives: positions over time, their optical flow, tracks of points, and files of them."""

from __future__ import annotations

from .export import motion_to_json, motion_to_svg
from .flow import FlowField, FlowSequence, all_triangles, layer_order, without_covered
from .frame_flow import FrameFlow, MotionVectors
from .motion import LoopReport, Motion
from .resampling import frame_at, sample_times
from .still_motion import stillness
from .tracking import FITS, Fit, Tracks, check_track_options, tracks

__all__ = [
    "FITS",
    "Fit",
    "FlowField",
    "FlowSequence",
    "FrameFlow",
    "LoopReport",
    "Motion",
    "MotionVectors",
    "Tracks",
    "all_triangles",
    "check_track_options",
    "frame_at",
    "layer_order",
    "motion_to_json",
    "motion_to_svg",
    "sample_times",
    "stillness",
    "tracks",
    "without_covered",
]
