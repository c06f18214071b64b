"""The part of the JSON Schema of scene documents that describes contact and colliders."""

from __future__ import annotations

from ..scene import Collider, Contact
from .encoding import COLLIDER_TYPES
from .schema_blocks import Schema, choice_of, number, object_of

__all__ = ["contact_definitions"]


def contact_definitions() -> dict[str, Schema]:
    """Contact and colliders, to stand under ``$defs``."""
    contact = {
        "friction": number("Friction", "0 slides freely, 1 hardly slides.", minimum=0, maximum=1),
        "thickness": number(
            "Thickness [px]",
            "Distance that bodies keep from each other. What is nearer as drawn keeps the distance it has.",
            exclusiveMinimum=0,
            maximum=100,
        ),
        "self_contact": {
            "type": "boolean",
            "title": "Self-contact",
            "description": "Whether a body also keeps out of itself, and its separate parts out of each other.",
        },
    }
    region = {**choice_of(COLLIDER_TYPES), "title": "Region", "description": "The shape: a polygon or a painted mask."}
    collider = object_of(Collider, "Collider", {"region": region})
    nullable = {**object_of(Contact, "Contact", contact), "type": ["object", "null"]}
    return {"contact": nullable, "collider": collider}
