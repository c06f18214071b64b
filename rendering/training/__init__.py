"""Training of the paper's two sketch ControlNets from a user's own clips (paper, Section 4.1; LVCD; ToonCrafter)."""

from __future__ import annotations

from .data_folder import ClipRecord, kept_clips, read_index
from .settings import TrainingSettings

__all__ = ["ClipRecord", "TrainingSettings", "kept_clips", "read_index"]
