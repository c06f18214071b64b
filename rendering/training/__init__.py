"""Training of the paper's two sketch ControlNets from a user's own clips (paper, Section 4.1; LVCD; ToonCrafter).

Data is built and encoded by ``physanimator dataset``, ``accelerate launch -m physanimator.rendering.training.lvcd`` and
``...training.tooncrafter`` train, and ``physanimator training export`` writes what Render and Interpolate load.
"""

from __future__ import annotations

from .data_folder import ClipRecord, kept_clips, read_index
from .settings import TrainingSettings

__all__ = ["ClipRecord", "TrainingSettings", "kept_clips", "read_index"]
