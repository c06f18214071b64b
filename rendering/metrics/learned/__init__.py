"""How good frames are, by networks: FID and VideoScore."""

from __future__ import annotations

from .files import FID_FILE, VIDEO_SCORE_FOLDER, require_file
from .videoscore import video_score

__all__ = [
    "FID_FILE",
    "VIDEO_SCORE_FOLDER",
    "require_file",
    "video_score",
]
