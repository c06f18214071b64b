"""Pictures that explain: what presets, strokes, stiffness and contact do."""

from __future__ import annotations

from .collisions import collision_figure
from .figures import stiffness_figure, strokes_figure
from .preset_figure import presets_figure

__all__ = [
    "collision_figure",
    "presets_figure",
    "stiffness_figure",
    "strokes_figure",
]
