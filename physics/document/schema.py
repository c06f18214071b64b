"""The JSON Schema of scene documents: what an editor completes from, and what a document is checked against.

Units stand in square brackets in each title. Defaults are those of the dataclasses.
"""

from __future__ import annotations

from ..forces import FALLOFFS, STROKE_KINDS, EnergyStroke, Wind
from ..limits import (
    LARGEST,
    MAX_BODIES,
    MAX_COLLIDERS,
    MAX_LOOP,
    MAX_MASK_PIXELS,
    MAX_PAINT,
    MAX_POINTS,
    MAX_QUERY_POINTS,
    MAX_RIG_POINTS,
    MAX_SIDE,
    MAX_STROKES,
    MAX_TRIANGLES,
    MAX_VERTICES,
    STIFFEST,
)
from ..material import PRESETS, Material
from ..rig import MOST_DEGREES, MOST_STRETCH
from ..scene import Body, Scene
from .contact_schema import contact_definitions
from .encoding import SCENE_VERSION
from .migration import READABLE_VERSIONS
from .paint_schema import paint_definitions
from .rig_schema import rig_definitions
from .schema_blocks import (
    ABOVE_0,
    ANY_SIZE,
    FROM_0,
    Schema,
    defined,
    list_of,
    number,
    object_of,
    pair_of_numbers,
    whole_number,
)
from .wind_schema import wind_properties

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
            "stroke": object_of(EnergyStroke, "Energy stroke", _stroke()),
            "wind": {**object_of(Wind, "Wind", wind_properties()), "type": ["object", "null"]},
            **rig_definitions(),
            **contact_definitions(),
            **paint_definitions(),
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
    return {
        "preset": {
            "enum": list(PRESETS),
            "title": "Preset",
            "description": "A material to start from; values given beside it replace the preset's own.",
        },
        "name": {"type": "string", "title": "Name", "description": 'What the material is called, such as "hair".'},
        "youngs_modulus": number(
            "Young's modulus [density side^2/s^2]",
            "Stiffness: how hard the body is to stretch and bend. Twice the sway needs four times the stiffness. A set"
            " sway_frequency takes its place.",
            exclusiveMinimum=0,
            maximum=STIFFEST,
        ),
        "poisson_ratio": number(
            "Poisson's ratio",
            "How much a stretched body narrows: 0 not at all, near 0.5 like rubber or jelly.",
            minimum=0,
            exclusiveMaximum=0.5,
        ),
        "density": number(
            "Density",
            "Mass for its size; 1 is ordinary. A heavier body of the same stiffness sways more slowly.",
            **ABOVE_0,
        ),
        "damping": number(
            "Damping [1/s]", "How fast motion dies away: 0 never, 1 within some seconds, 5 almost at once.", **FROM_0
        ),
        "sway_frequency": {
            **number(
                "Sway frequency [Hz]",
                "How often the body sways about where it is held; hair sways about once a second. Its shorter separate"
                " parts sway faster. The stiffness follows from it. null: use youngs_modulus.",
                minimum=0.001,
                maximum=1000,
            ),
            "type": ["number", "null"],
        },
        "stretch_limit": {
            **number(
                "Stretch limit",
                "How many times as far as in the drawing a point gets from where its part is held, at most, as if on"
                " a thread: 1.06 for hair and ribbon, which bend but do not stretch. null: no limit.",
                minimum=1,
                maximum=LARGEST,
            ),
            "type": ["number", "null"],
        },
        "wind_response": number(
            "Wind response",
            "How strongly wind and strokes act on the body: 1 is ordinary, 2 light as paper, 0.5 heavy, 0 not at all.",
            **FROM_0,
        ),
        **{
            f"{quantity}_scale": {
                "type": ["array", "null"],
                "title": f"{quantity.capitalize()} scale",
                "description": f"A factor on the {quantity} of each triangle of the mesh; null means 1 everywhere.",
                "items": {"$ref": "#/$defs/factor"},
                "maxItems": MAX_TRIANGLES,
            }
            for quantity in ("stiffness", "damping", "density")
        },
    }


def _mesh() -> dict[str, Schema]:
    return {
        "vertices": list_of("Vertices [px]", "Positions at rest.", "point", MAX_VERTICES, least=3),
        "triangles": list_of("Triangles", "Three vertex numbers each, from 0.", "triangle", MAX_TRIANGLES, least=1),
    }


def _stroke() -> dict[str, Schema]:
    return {
        "kind": {
            "enum": list(STROKE_KINDS),
            "title": "Kind",
            "description": "wind blows along the path; repel pushes away, hardest at the radius; attract pulls"
            " closer, hardest at the centre (with a negative strength it pushes away, hardest at the centre).",
        },
        "path": list_of(
            "Path [px]",
            "The points that particles travel along, in order, at least two for wind. One point is a particle at rest.",
            "point",
            MAX_POINTS,
            least=1,
        ),
        "radius": number("Radius [px]", "How far a particle reaches; nothing beyond is touched.", **ABOVE_0),
        "speed": number(
            "Speed [px/s]",
            "How fast particles travel along the path. 0 is one particle at rest at the first point.",
            **FROM_0,
        ),
        "strength": number(
            "Strength [side/s^2]",
            "Acceleration at full effect. 1 is a breeze, 5 a storm. Negative turns the direction round.",
            **ANY_SIZE,
        ),
        "start": number("Start [s]", "When the first particle leaves.", **FROM_0),
        "end": {
            **number("End [s]", "When particles stop leaving; after start. null: never.", **ABOVE_0),
            "type": ["number", "null"],
        },
        "interval": number(
            "Interval [s]",
            "Time from one particle to the next: 0.1 sends ten a second, 2 lets single gusts pass.",
            minimum=0.01,
            maximum=LARGEST,
        ),
        "falloff": {
            "enum": list(FALLOFFS),
            "title": "Falloff",
            "description": "How the effect falls off up to the radius: linear (for repel it grows), smooth without a"
            " kink, constant not at all.",
        },
        "repeat": {
            **number(
                "Repeat [s]",
                "The time from start to end begins anew every so often. null: never.",
                minimum=0.01,
                maximum=LARGEST,
            ),
            "type": ["number", "null"],
        },
        "strength_keys": list_of(
            "Strength along the path",
            "How the strength changes along the path; between two keys, evenly. Empty: not at all.",
            "strength_key",
            100,
        ),
        "speed_keys": list_of(
            "Speed along the path",
            "How the speed changes along the path; between two keys, evenly. Empty: not at all.",
            "speed_key",
            100,
        ),
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
