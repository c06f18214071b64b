"""The scene: bodies, strokes, wind, rig points, paint and colliders; the automatic scene; and advice about it."""

from __future__ import annotations

from .advising import absent_bodies, advice, unused_rig_points
from .attachment import held_where_said, pins
from .automatic import automatic_scene
from .collider_outlines import (
    LEAST_SPACING,
    MAX_OUTLINE_CROSSINGS,
    OutlineCounts,
    count_outlines,
    outlines,
    spacing_of,
    window_of,
)
from .collision import Collider, Contact
from .doubtful_masks import doubts_about_mask, mask_advice
from .holds import Holds, holds_of, region_work
from .paint import QUANTITIES, Paint
from .query_points import QueryPoint
from .scene import Body, Scene, StrokesAs, check_scene_rate
from .shapes import LayerRegion
from .sides import ATTACHMENTS, Attachment, Held

__all__ = [
    "ATTACHMENTS",
    "LEAST_SPACING",
    "MAX_OUTLINE_CROSSINGS",
    "QUANTITIES",
    "Attachment",
    "Body",
    "Collider",
    "Contact",
    "Held",
    "Holds",
    "LayerRegion",
    "OutlineCounts",
    "Paint",
    "QueryPoint",
    "Scene",
    "StrokesAs",
    "absent_bodies",
    "advice",
    "automatic_scene",
    "check_scene_rate",
    "count_outlines",
    "doubts_about_mask",
    "held_where_said",
    "holds_of",
    "mask_advice",
    "outlines",
    "pins",
    "region_work",
    "spacing_of",
    "unused_rig_points",
    "window_of",
]
