"""The JSON Schema of scene documents: what an editor completes from, and what a document is checked against.

Units stand in square brackets in each title. Defaults are those of the dataclasses.
"""

from __future__ import annotations

from ..forces import EnergyStroke, Wind
from ..limits import (
    LARGEST,
    MAX_BODIES,
    MAX_COLLIDERS,
    MAX_LOOP,
    MAX_MASK_PIXELS,
    MAX_PAINT,
    MAX_QUERY_POINTS,
    MAX_RIG_POINTS,
    MAX_SIDE,
    MAX_STROKES,
    MAX_TRIANGLES,
    MAX_VERTICES,
)
from ..material import PRESETS, SCALES, Material
from ..rig import MOST_DEGREES, MOST_STRETCH
from ..scene import Body, Collider, Contact, Paint, QueryPoint, Scene
from .encoding import COLLIDER_TYPES, SCENE_VERSION
from .migration import READABLE_VERSIONS
from .rig_schema import rig_definitions
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
    properties_of,
    whole_number,
)

__all__ = ["scene_schema"]

_EXAMPLE = {
    "version": 2,
    "width": 1280,
    "height": 720,
    "bodies": [{"name": "hair", "material": {"preset": "hair", "damping": 2}}],
    "strokes": [{"kind": "wind", "path": [[100, 400], [1200, 350]], "radius": 300, "speed": 500, "strength": 1.5}],
    "rig_points": [
        {"position": [640, 120], "region": {"type": "circle", "radius": 60}},
        {"position": [700, 600], "motion": {"type": "wave", "amplitude": 15, "period": 2.5, "direction": [1, 0]}},
    ],
}


def scene_schema() -> Schema:
    """The JSON Schema (draft 2020-12) of a scene document."""
    shape = choice_of(COLLIDER_TYPES)
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": f"urn:physanimator:scene:{SCENE_VERSION}",
        "description": "What moves in one illustration, and what moves it. Positions are pixels of the illustration: x"
        " to the right, y down, from its top left corner. A side is the illustration's longest side. Times are"
        " seconds from the start.",
        "examples": [_EXAMPLE],
        **object_of(Scene, "PhysAnimator scene", _document(), required=["version", "width", "height"]),
        "$defs": {
            "body": object_of(Body, "Body", _body(), required=[]),
            "material": object_of(Material, "Material", _material()),
            "mesh": object_of(None, "Mesh", _mesh(), required=["vertices", "triangles"]),
            "stroke": object_of(EnergyStroke, "Energy stroke", properties_of(EnergyStroke)),
            "wind": {**object_of(Wind, "Wind", properties_of(Wind)), "type": ["object", "null"]},
            **rig_definitions(),
            "contact": {**object_of(Contact, "Contact", properties_of(Contact)), "type": ["object", "null"]},
            "collider": object_of(Collider, "Collider", properties_of(Collider, region=shape)),
            "query_point": object_of(QueryPoint, "Query point", properties_of(QueryPoint)),
            "paint": object_of(Paint, "Paint", properties_of(Paint, region=shape)),
            **_entries(),
        },
    }


def _document() -> dict[str, Schema]:
    return {
        "$schema": {"type": "string", "title": "Schema", "description": "Where editors find this schema; not read."},
        "version": {
            "enum": list(READABLE_VERSIONS),
            "title": "Version",
            "description": f"Version of the format, now {SCENE_VERSION}; a document of version 1 is read as before.",
        },
        "width": whole_number("Width [px]", "Width of the illustration that the positions refer to.", 1, MAX_SIDE),
        "height": whole_number("Height [px]", "Height of the illustration that the positions refer to.", 1, MAX_SIDE),
        "frame_rate": number(
            "Frame rate [frames/s]", "How many frames a second has. The motion stays the same.", minimum=1, maximum=240
        ),
        "loop": {
            **number(
                "Loop [s]",
                "Length of a seamless loop: all that acts is fitted to it, and the first frame is not the drawing but"
                " one that comes again after the last. null: no loop.",
                exclusiveMinimum=0,
                maximum=MAX_LOOP,
            ),
            "type": ["number", "null"],
        },
        "wind": {"$ref": "#/$defs/wind"},
        "gravity": pair_of_numbers(
            "Gravity [side/s^2]",
            "A steady pull on everything, x and y. [0, 0.5] pulls down gently. Held bodies hang as they are drawn.",
            **ANY_SIZE,
        ),
        "sag": {
            "type": "boolean",
            "title": "Sag",
            "description": "Whether bodies are drawn without their weight, so that gravity makes them sag from the"
            " first frame on.",
        },
        "bodies": list_of(
            "Bodies",
            "What can move, in the order of the masks. Bodies left out are of default material.",
            "body",
            MAX_BODIES,
        ),
        "strokes": list_of("Energy strokes", "What blows, pushes and pulls.", "stroke", MAX_STROKES),
        "rig_points": list_of(
            "Rig points",
            "Where bodies are held or led. Where several reach the same part, the last one in this list leads it.",
            "rig_point",
            MAX_RIG_POINTS,
        ),
        "contact": {
            **defined("contact"),
            "type": ["object", "null"],
            "description": "How bodies keep out of each other and of colliders. null: they pass through.",
        },
        "colliders": list_of(
            "Colliders",
            "Still shapes that bodies keep out of where there is contact, such as a shoulder under hair.",
            "collider",
            MAX_COLLIDERS,
        ),
        "paint": list_of(
            "Paint",
            "Where bodies are stiffer, heavier or more damped than their materials say; entries that overlap multiply.",
            "paint",
            MAX_PAINT,
        ),
        "query_points": list_of(
            "Query points",
            "Where somebody clicked to say which part of the illustration is meant: for segmentation, not for motion.",
            "query_point",
            MAX_QUERY_POINTS,
        ),
    }


def _body() -> dict[str, Schema]:
    return {
        "name": {"type": "string", "title": "Name", "description": 'For people, such as "left sleeve".'},
        "layer": whole_number(
            "Layer", "Who covers whom: a higher layer is in front; of equal layers the later body.", -LARGEST, LARGEST
        ),
        "material": {"$ref": "#/$defs/material"},
        "mesh": {"$ref": "#/$defs/mesh"},
    }


def _material() -> dict[str, Schema]:
    preset = {
        "enum": list(PRESETS),
        "title": "Preset",
        "description": "A material to start from; values given beside it replace the preset's own.",
    }
    own = properties_of(Material)
    scales = {name: own.pop(name) for name in SCALES}
    return {"preset": preset, "name": own.pop("name"), **own, **scales}


def _mesh() -> dict[str, Schema]:
    return {
        "vertices": list_of("Vertices [px]", "Positions at rest.", "point", MAX_VERTICES, least=3),
        "triangles": list_of("Triangles", "Three vertex numbers each, from 0.", "triangle", MAX_TRIANGLES, least=1),
    }


def _entries() -> dict[str, Schema]:
    """The entries of long lists."""
    whole = {"type": "integer", "minimum": 0}
    return {
        "point": pair_of_numbers("Point [px]", "x to the right, y down.", **ANY_SIZE),
        "strength_key": pair_of_numbers(
            "Key", "Part of the path from 0 to 1, and a factor on the strength there.", **ANY_SIZE
        ),
        "speed_key": pair_of_numbers("Key", "Part of the path from 0 to 1, and a factor above 0 there.", **FROM_0),
        "time": {"type": "number", **FROM_0},
        "factor": {"type": "number", **ABOVE_0},
        "angle": {"type": "number", "minimum": -MOST_DEGREES, "maximum": MOST_DEGREES},
        "stretch": {"type": "number", "minimum": 1 / MOST_STRETCH, "maximum": MOST_STRETCH},
        "run": {**whole, "maximum": MAX_MASK_PIXELS},
        "triangle": {
            "type": "array",
            "items": {**whole, "maximum": MAX_VERTICES - 1},
            "minItems": 3,
            "maxItems": 3,
        },
    }
