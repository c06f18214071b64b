"""The part of the JSON Schema of scene documents that describes rig points."""

from __future__ import annotations

from .limits import LARGEST, MAX_BODIES, MAX_MASK_PIXELS, MAX_POINTS, MAX_SIDE
from .rig import Circle, KeyedPath, MaskRegion, Pinned, Polygon, RigPoint, Wave
from .scene_encoding import MOTION_TYPES, REGION_TYPES
from .schema_blocks import (
    ABOVE_0,
    ANY_SIZE,
    Schema,
    choice_of,
    defined,
    list_of,
    number,
    object_of,
    pair_of_numbers,
    typed_object,
    whole_number,
)

__all__ = ["rig_definitions"]


def rig_definitions() -> dict[str, Schema]:
    """Rig points, regions and motions, to stand under ``$defs``."""
    return {"rig_point": object_of(RigPoint, "Rig point", _rig_point()), **_regions(), **_motions()}


def _rig_point() -> dict[str, Schema]:
    return {
        "position": {**defined("point"), "title": "Position [px]", "description": "Where the rig point is drawn."},
        "region": {
            **choice_of(REGION_TYPES),
            "title": "Region",
            "description": "Which part of the body it takes along.",
        },
        "motion": {**choice_of(MOTION_TYPES), "title": "Motion", "description": "How that part moves."},
        "body": {
            **whole_number(
                "Body", "Number of the only body that it acts on, from 0. null: every body.", 0, MAX_BODIES - 1
            ),
            "type": ["integer", "null"],
        },
    }


def _regions() -> dict[str, Schema]:
    pixels = whole_number("Size [px]", "Size of the painted mask; it is stretched over the illustration.", 1, MAX_SIDE)
    circle = {"radius": number("Radius [px]", "What is this near to the position is taken along.", **ABOVE_0)}
    corners = list_of("Corners [px]", "Corners of a closed outline, in order.", "point", MAX_POINTS, least=3)
    runs = list_of(
        "Runs",
        "Lengths of runs of pixels, row by row from the top left: empty, painted, empty, painted and so on. They add"
        " up to width x height.",
        "run",
        MAX_MASK_PIXELS,
        least=1,
    )
    mask = {"width": pixels, "height": pixels, "runs": runs}
    return {
        "circle": typed_object(Circle, "circle", "Circle about the position", circle),
        "polygon": typed_object(Polygon, "polygon", "Polygon", {"points": corners}),
        "mask": typed_object(MaskRegion, "mask", "Painted mask", mask, required=["width", "height", "runs"]),
    }


def _motions() -> dict[str, Schema]:
    path = {
        "times": list_of("Times [s]", "When each point is reached, rising.", "time", MAX_POINTS, least=2),
        "points": list_of(
            "Points [px]",
            "Where the rig point is at each time. The part moves by the difference to the first.",
            "point",
            MAX_POINTS,
            least=2,
        ),
    }
    wave = {
        "amplitude": number("Amplitude [px]", "How far it swings to each side.", **ANY_SIZE),
        "period": number("Period [s]", "Time of one swing forth and back.", minimum=0.01, maximum=LARGEST),
        "direction": pair_of_numbers(
            "Direction", "Which way it swings first, x and y, of any length but 0.", **ANY_SIZE
        ),
    }
    return {
        "pinned": typed_object(Pinned, "pinned", "Pinned: held where it was drawn", {}),
        "path": typed_object(KeyedPath, "path", "Path: led through points at given times", path),
        "wave": typed_object(Wave, "wave", "Wave: swings to and fro", wave),
    }
