"""All columns in their order: the paper's first, then those that need no weights."""

from __future__ import annotations

from .column import Column
from .fid import FID
from .hole_ratio import HOLE_RATIO
from .loop_residual import LOOP_RESIDUAL
from .lpips import LPIPS
from .seen_flow import DYNAMIC_DEGREE, FLOW_WARP_ERROR
from .simulated_flow_error import SIMULATED_FLOW_ERROR
from .sketch_adherence import SKETCH_ADHERENCE
from .static_drift import STATIC_DRIFT
from .video_score import VIDEO_SCORES

__all__ = ["COLUMNS"]

COLUMNS: tuple[Column, ...] = (
    FID,
    *VIDEO_SCORES,
    FLOW_WARP_ERROR,
    SIMULATED_FLOW_ERROR,
    STATIC_DRIFT,
    SKETCH_ADHERENCE,
    DYNAMIC_DEGREE,
    HOLE_RATIO,
    LOOP_RESIDUAL,
    LPIPS,
)
