"""The JSON Schema of scene documents: what an editor completes from, and what a document is checked against.

Units stand in square brackets in each title. Defaults are those of the dataclasses.
"""

from __future__ import annotations

from ..forces import EnergyStroke, Wind
from ..limits import (
    MAX_MASK_PIXELS,
    MAX_SIDE,
    MAX_TRIANGLES,
    MAX_VERTICES,
)
from ..material import PRESETS, SCALES, Material
from ..rig import MOST_DEGREES, MOST_STRETCH
from ..scene import Body, Collider, Contact, LayerRegion, Paint, QueryPoint, Scene
from .encoding import COLLIDER_TYPES, SCENE_VERSION, SHAPE_TYPES
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
    object_of,
    pair_of_numbers,
    properties_of,
    typed_object,
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
    """The JSON Schema (draft 2020-12) of a scene document.

    Examples:
        >>> from physanimator.physics.document import scene_schema
        >>> scene_schema()["type"]
        'object'
    """
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
            "collider": object_of(Collider, "Collider", properties_of(Collider, region=choice_of(COLLIDER_TYPES))),
            "layer": typed_object(LayerRegion, "layer", "Layer", _layer(), required=["name"]),
            "query_point": object_of(QueryPoint, "Query point", properties_of(QueryPoint)),
            "paint": object_of(Paint, "Paint", properties_of(Paint, region=choice_of(SHAPE_TYPES))),
            **_entries(),
        },
    }


def _document() -> dict[str, Schema]:
    own = properties_of(Scene, wind={}, contact={})
    return {
        "$schema": {"type": "string", "title": "Schema", "description": "Where editors find this schema; not read."},
        "version": {
            "enum": list(READABLE_VERSIONS),
            "title": "Version",
            "description": f"Version of the format, now {SCENE_VERSION}; a document of version 1 is read as before.",
        },
        "width": whole_number("Width [px]", "Width of the illustration that the positions refer to.", 1, MAX_SIDE),
        "height": whole_number("Height [px]", "Height of the illustration that the positions refer to.", 1, MAX_SIDE),
        **{name: own[name] for name in ("frame_rate", "loop")},
        "wind": defined("wind"),
        **{
            name: own[name] for name in ("gravity", "sag", "time_step", "strokes_as", "bodies", "strokes", "rig_points")
        },
        "contact": {**defined("contact"), "type": ["object", "null"], "description": own["contact"]["description"]},
        **{name: own[name] for name in ("colliders", "paint", "query_points", "still", "order")},
    }


def _body() -> dict[str, Schema]:
    own = properties_of(Body, material={}, mesh={})
    return {
        "name": own["name"],
        "layer": own["layer"],
        "strands": own["strands"],
        "attach": own["attach"],
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


def _layer() -> dict[str, Schema]:
    about = "Name of a layer of the artwork that stands still."
    return {"name": {"type": "string", "title": "Name", "description": about}}


def _entries() -> dict[str, Schema]:
    """The entries of long lists."""
    whole = {"type": "integer", "minimum": 0}
    return {
        "point": pair_of_numbers("Point [px]", "x to the right, y down.", **ANY_SIZE),
        "strength_key": pair_of_numbers(
            "Key", "Part of the path from 0 to 1, and a factor on the strength there.", **ANY_SIZE
        ),
        "speed_key": pair_of_numbers("Key", "Part of the path from 0 to 1, and a factor above 0 there.", **FROM_0),
        "layer_name": {"type": "string"},
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
