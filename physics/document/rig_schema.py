"""The part of the JSON Schema of scene documents that describes rig points."""

from __future__ import annotations

from ..limits import MAX_MASK_PIXELS, MAX_SIDE
from ..rig import (
    Circle,
    Combined,
    KeyedPath,
    MaskRegion,
    Pinned,
    Polygon,
    Pulse,
    RigPoint,
    Rotation,
    Squash,
    Swing,
    Wave,
)
from .encoding import MOTION_TYPES, REGION_TYPES
from .schema_blocks import Schema, choice_of, list_of, object_of, properties_of, typed_object, whole_number

__all__ = ["rig_definitions"]


def rig_definitions() -> dict[str, Schema]:
    """Rig points, regions and motions, to stand under ``$defs``."""
    parts = {"region": choice_of(REGION_TYPES), "motion": choice_of(MOTION_TYPES)}
    return {
        "rig_point": object_of(RigPoint, "Rig point", properties_of(RigPoint, **parts)),
        "circle": typed_object(Circle, "circle", "Circle about the position"),
        "polygon": typed_object(Polygon, "polygon", "Polygon"),
        "mask": typed_object(MaskRegion, "mask", "Painted mask", _mask(), required=["width", "height", "runs"]),
        "pinned": typed_object(Pinned, "pinned", "Pinned: held where it was drawn"),
        "path": typed_object(KeyedPath, "path", "Path: led through points at given times"),
        "wave": typed_object(Wave, "wave", "Wave: swings to and fro"),
        "rotation": typed_object(Rotation, "rotation", "Rotation: turned about the position"),
        "swing": typed_object(Swing, "swing", "Swing: turned to and fro about the position"),
        "squash": typed_object(Squash, "squash", "Squash: stretched and squashed about the position"),
        "pulse": typed_object(Pulse, "pulse", "Pulse: stretched and squashed to and fro"),
        "combined": typed_object(Combined, "combined", "Combined: several motions at once", _combined()),
    }


def _mask() -> dict[str, Schema]:
    pixels = whole_number("Size [px]", "Size of the painted mask; it is stretched over the illustration.", 1, MAX_SIDE)
    runs = list_of(
        "Runs",
        "Lengths of runs of pixels, row by row from the top left: empty, painted, empty, painted and so on. They add"
        " up to width x height.",
        "run",
        MAX_MASK_PIXELS,
        least=1,
    )
    return {"width": pixels, "height": pixels, "runs": runs}


def _combined() -> dict[str, Schema]:
    single = choice_of({name: kind for name, kind in MOTION_TYPES.items() if kind is not Combined})
    return properties_of(Combined, motions=single)
