"""Scenes, flow and tracks drawn over the picture."""

from __future__ import annotations

from .flow_colour import flow_to_color
from .overlay import draw_strokes, draw_wireframe, preview
from .track_overlay import draw_tracks, reframed

__all__ = [
    "draw_strokes",
    "draw_tracks",
    "draw_wireframe",
    "flow_to_color",
    "preview",
    "reframed",
]
