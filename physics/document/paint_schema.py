"""The part of the JSON Schema of scene documents that describes query points and paint."""

from __future__ import annotations

from ..limits import MAX_BODIES, MAX_PARTS
from ..scene import LEAST_FACTOR, MOST_FACTOR, Paint, QueryPoint
from .encoding import COLLIDER_TYPES
from .schema_blocks import ANY_SIZE, Schema, choice_of, number, object_of, whole_number

__all__ = ["paint_definitions"]

_BOUNDS = {"minimum": LEAST_FACTOR, "maximum": MOST_FACTOR}


def paint_definitions() -> dict[str, Schema]:
    """Query points and paint, to stand under ``$defs``."""
    query_point = {
        "x": number("x [px]", "From the left edge of the illustration.", **ANY_SIZE),
        "y": number("y [px]", "From the top edge of the illustration.", **ANY_SIZE),
        "positive": {
            "type": "boolean",
            "title": "Positive",
            "description": "true on the wanted part, false beside it.",
        },
        "part": whole_number(
            "Part", "Number of the part that is meant, from 0, where several are cut out at once.", 0, MAX_PARTS - 1
        ),
    }
    paint = {
        "region": {
            **choice_of(COLLIDER_TYPES),
            "title": "Region",
            "description": "Where: a polygon or a painted mask.",
        },
        "stiffness": number(
            "Stiffness", "Factor on the stiffness there. A body with a sway frequency still sways as often.", **_BOUNDS
        ),
        "damping": number("Damping", "Factor on the damping there.", **_BOUNDS),
        "density": number("Density", "Factor on the density there.", **_BOUNDS),
        "body": {
            **whole_number(
                "Body", "Number of the only body that it acts on, from 0. null: every body.", 0, MAX_BODIES - 1
            ),
            "type": ["integer", "null"],
        },
    }
    return {
        "query_point": object_of(QueryPoint, "Query point", query_point),
        "paint": object_of(Paint, "Paint", paint),
    }
