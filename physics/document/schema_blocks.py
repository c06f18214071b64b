"""The blocks that the JSON Schema of scene documents is built from."""

from __future__ import annotations

from dataclasses import MISSING, fields
from typing import Any

from ..fields import DescribedField, Field, described_fields
from ..limits import LARGEST
from .encoding import encode

__all__ = [
    "ABOVE_0",
    "ANY_SIZE",
    "FROM_0",
    "Schema",
    "bounds_of",
    "choice_of",
    "defined",
    "list_of",
    "number",
    "object_of",
    "pair_of_numbers",
    "properties_of",
    "typed_object",
    "whole_number",
]

Schema = dict[str, Any]

_TYPES = {float: "number", int: "integer", bool: "boolean", str: "string"}

ABOVE_0 = {"exclusiveMinimum": 0, "maximum": LARGEST}
FROM_0 = {"minimum": 0, "maximum": LARGEST}
ANY_SIZE = {"minimum": -LARGEST, "maximum": LARGEST}


def object_of(
    kind: type | None, title: str, properties: dict[str, Schema], *, required: list[str] | None = None
) -> Schema:
    """An object with no other keys, its defaults and, unless told, its required keys those of a dataclass."""
    of_class = {field.name.rstrip("_"): field for field in fields(kind)} if kind else {}
    described = {}
    for name, schema in properties.items():
        has_default = name in of_class and of_class[name].default is not MISSING
        described[name] = {**schema, "default": encode(of_class[name].default)} if has_default else schema
    if required is None:
        required = [name for name in properties if name in of_class and "default" not in described[name]]
    schema = {"title": title, "type": "object", "properties": described, "additionalProperties": False}
    return {**schema, "required": required} if required else schema


def properties_of(kind: type, **others: Schema) -> dict[str, Schema]:
    """The described fields of a dataclass as properties, by name.

    Args:
        kind: the dataclass.
        others: what a field is that holds objects, or what the entries of its list are.
    """
    return {each.key: _property(each, others.get(name)) for name, each in described_fields(kind).items()}


def _property(described: DescribedField, form: Schema | None) -> Schema:
    field = described.field
    text: Schema = {"title": field.heading, "description": field.about}
    if form is None and described.choices:
        return {"enum": list(described.choices), **text}
    if field.entry and not field.most:
        return {**defined(field.entry), **text}
    if field.most and form is None:
        found = list_of(field.heading, field.about, field.entry, field.most, least=field.least)
    elif field.most:
        found = {"type": "array", **text, "items": form, "minItems": field.least, "maxItems": field.most}
    elif form is not None:
        found = {**form, **text}
    elif described.type in _TYPES:
        bounds = bounds_of(field) if described.type in (int, float) else {}
        found = {"type": _TYPES[described.type], **text, **bounds}
    else:
        found = pair_of_numbers(field.heading, field.about, **bounds_of(field))
    return {**found, "type": [found["type"], "null"]} if described.nullable and "type" in found else found


def bounds_of(field: Field) -> Schema:
    """The bounds of a number."""
    low = {"minimum": field.minimum} if field.above is None else {"exclusiveMinimum": field.above}
    high = {"maximum": field.maximum} if field.below is None else {"exclusiveMaximum": field.below}
    return {**low, **high}


def typed_object(
    kind: type, name: str, title: str, properties: dict[str, Schema] | None = None, *, required: list[str] | None = None
) -> Schema:
    """An object told from its siblings by its type; its properties, unless told, are its class's described fields."""
    own = properties_of(kind) if properties is None else properties
    return object_of(kind, title, {"type": {"const": name, "title": "Type"}, **own}, required=required)


def choice_of(types: dict[str, type]) -> Schema:
    """One of several typed objects, so told apart that a wrong value is reported for the type that it names."""
    rules = [
        {"if": {"properties": {"type": {"const": name}}, "required": ["type"]}, "then": defined(name)} for name in types
    ]
    return {"type": "object", "properties": {"type": {"enum": list(types)}}, "required": ["type"], "allOf": rules}


def number(title: str, description: str, **bounds: float) -> Schema:
    """A number; the unit stands in square brackets at the end of the title."""
    return {"type": "number", "title": title, "description": description, **bounds}


def whole_number(title: str, description: str, least: int, most: int) -> Schema:
    """A whole number within bounds."""
    return {"type": "integer", "title": title, "description": description, "minimum": least, "maximum": most}


def pair_of_numbers(title: str, description: str, **bounds: float) -> Schema:
    """A list of two numbers, each within the bounds."""
    items = {"type": "number", **bounds}
    return {
        "type": "array",
        "title": title,
        "description": description,
        "items": items,
        "minItems": 2,
        "maxItems": 2,
    }


def list_of(title: str, description: str, entry: str, most: int, *, least: int = 0) -> Schema:
    """A list of entries defined under ``$defs``."""
    schema = {"type": "array", "title": title, "description": description, "items": defined(entry), "maxItems": most}
    return {**schema, "minItems": least} if least else schema


def defined(name: str) -> Schema:
    """What stands under ``$defs`` by that name."""
    return {"$ref": f"#/$defs/{name}"}
