"""Masks from points and boxes: by colours and lines without a network."""

from __future__ import annotations

from .cut_judgement import judge_cuts, judge_points
from .grabcut import segment
from .part_masks import segment_parts
from .prompts import Prompt, checked_box, checked_points, prompts_of, require_object

__all__ = [
    "Prompt",
    "checked_box",
    "checked_points",
    "judge_cuts",
    "judge_points",
    "prompts_of",
    "require_object",
    "segment",
    "segment_parts",
]
