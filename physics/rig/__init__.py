"""Rig points: the region that each holds, and how it leads it: pinned, along keys, in waves, turned, squashed."""

from __future__ import annotations

from .falloff import FIRMNESS, grip_at
from .leading import farthest_led, lead, linear_part
from .regions import EDGE, Points, coarseness_of, displacement, distances_of, leaders_of, vertices_of
from .rig_point import (
    MOST_COMBINED,
    BodyNumber,
    Circle,
    Combined,
    KeyedPath,
    MaskRegion,
    Pinned,
    Polygon,
    RigMotion,
    RigPoint,
    RigRegion,
    Wave,
)
from .turns import EASINGS, MOST_DEGREES, MOST_STRETCH, Pulse, Rotation, Squash, Swing

__all__ = [
    "EASINGS",
    "EDGE",
    "FIRMNESS",
    "MOST_COMBINED",
    "MOST_DEGREES",
    "MOST_STRETCH",
    "BodyNumber",
    "Circle",
    "Combined",
    "KeyedPath",
    "MaskRegion",
    "Pinned",
    "Points",
    "Polygon",
    "Pulse",
    "RigMotion",
    "RigPoint",
    "RigRegion",
    "Rotation",
    "Squash",
    "Swing",
    "Wave",
    "coarseness_of",
    "displacement",
    "distances_of",
    "farthest_led",
    "grip_at",
    "lead",
    "leaders_of",
    "linear_part",
    "vertices_of",
]
