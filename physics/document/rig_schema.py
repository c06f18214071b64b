"""The part of the JSON Schema of scene documents that describes rig points."""

from __future__ import annotations

from ..limits import LARGEST, MAX_BODIES, MAX_MASK_PIXELS, MAX_POINTS, MAX_SIDE
from ..rig import (
    EASINGS,
    MOST_COMBINED,
    MOST_DEGREES,
    MOST_STRETCH,
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
from .schema_blocks import (
    ABOVE_0,
    ANY_SIZE,
    FROM_0,
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
        "falloff": number(
            "Falloff [px]",
            "How far beyond the region its pull fades out. 0: everything outside moves freely.",
            **FROM_0,
        ),
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
        "easing": _easing(),
    }
    wave = {
        "amplitude": number("Amplitude [px]", "How far it swings to each side.", **ANY_SIZE),
        "period": number("Period [s]", "Time of one swing forth and back.", minimum=0.01, maximum=LARGEST),
        "direction": pair_of_numbers(
            "Direction", "Which way it swings first, x and y, of any length but 0.", **ANY_SIZE
        ),
        "phase": _phase(),
    }
    return {
        "pinned": typed_object(Pinned, "pinned", "Pinned: held where it was drawn", {}),
        "path": typed_object(KeyedPath, "path", "Path: led through points at given times", path),
        "wave": typed_object(Wave, "wave", "Wave: swings to and fro", wave),
        "rotation": typed_object(Rotation, "rotation", "Rotation: turned about the position", _rotation()),
        "swing": typed_object(Swing, "swing", "Swing: turned to and fro about the position", _swing()),
        "squash": typed_object(Squash, "squash", "Squash: stretched and squashed about the position", _squash()),
        "pulse": typed_object(Pulse, "pulse", "Pulse: stretched and squashed to and fro", _pulse()),
        "combined": typed_object(Combined, "combined", "Combined: several motions at once", _combined()),
    }


def _rotation() -> dict[str, Schema]:
    return {
        "times": list_of("Times [s]", "When each angle is reached, rising.", "time", MAX_POINTS, least=2),
        "angles": list_of(
            "Angles [degrees]",
            "How far it is turned at each time, counterclockwise. It turns by the difference to the first.",
            "angle",
            MAX_POINTS,
            least=2,
        ),
        "easing": _easing(),
    }


def _swing() -> dict[str, Schema]:
    return {
        "amplitude": number(
            "Amplitude [degrees]",
            "How far it turns to each side, counterclockwise first.",
            minimum=-MOST_DEGREES,
            maximum=MOST_DEGREES,
        ),
        "period": number("Period [s]", "Time of one swing forth and back.", minimum=0.01, maximum=LARGEST),
        "phase": _phase(),
    }


def _squash() -> dict[str, Schema]:
    return {
        "times": list_of("Times [s]", "When each factor is reached, rising.", "time", MAX_POINTS, least=2),
        "factors": list_of(
            "Factors",
            "Length at each time; above 1 stretches, below squashes. It is stretched by the ratio to the first.",
            "stretch",
            MAX_POINTS,
            least=2,
        ),
        **_stretching(),
        "easing": _easing(),
    }


def _pulse() -> dict[str, Schema]:
    return {
        "stretch": number(
            "Stretch",
            "Largest factor; 1.2 stretches by a fifth and squashes to 1 / 1.2.",
            minimum=1 / MOST_STRETCH,
            maximum=MOST_STRETCH,
        ),
        "period": number("Period [s]", "Time from one stretch to the next.", minimum=0.01, maximum=LARGEST),
        "phase": _phase(),
        **_stretching(),
    }


def _stretching() -> dict[str, Schema]:
    return {
        "angle": number(
            "Angle [degrees]",
            "Direction of the stretching: 0 along x, 90 along y.",
            minimum=-MOST_DEGREES,
            maximum=MOST_DEGREES,
        ),
        "keep_area": {
            "type": "boolean",
            "title": "Keep area",
            "description": "Whether it narrows as much as it is stretched.",
        },
    }


def _combined() -> dict[str, Schema]:
    motions = {
        "type": "array",
        "title": "Motions",
        "description": "Ways add up; turns and squashes act about the moving position, one after the other.",
        "items": choice_of({name: kind for name, kind in MOTION_TYPES.items() if kind is not Combined}),
        "minItems": 1,
        "maxItems": MOST_COMBINED,
    }
    return {"motions": motions}


def _easing() -> Schema:
    return {
        "enum": list(EASINGS),
        "title": "Easing",
        "description": "smooth: flows through the keys; linear: at even speed; ease: stops at every key; hold: stays,"
        " then jumps.",
    }


def _phase() -> Schema:
    return number(
        "Phase [degrees]",
        "Where in its course it begins, from where it was drawn; at -90 it begins at rest.",
        minimum=-MOST_DEGREES,
        maximum=MOST_DEGREES,
    )
