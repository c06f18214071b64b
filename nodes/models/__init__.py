"""Networks as the host keeps them: which files there are, how they are loaded, and whose memory they are in."""

from __future__ import annotations

from .model_files import find_model_file
from .other_segmenters import segmenter_advice

__all__ = [
    "find_model_file",
    "segmenter_advice",
]
