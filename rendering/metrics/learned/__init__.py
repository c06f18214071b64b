"""How good frames are, by networks: FID and VideoScore."""

from __future__ import annotations

from .files import FID_FILE, LPIPS_FOLDER, VIDEO_SCORE_FOLDER, MetricFile, require_file
from .videoscore import check_video_score, video_score

__all__ = [
    "FID_FILE",
    "LPIPS_FOLDER",
    "VIDEO_SCORE_FOLDER",
    "MetricFile",
    "check_video_score",
    "require_file",
    "video_score",
]
