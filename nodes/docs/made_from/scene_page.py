"""The reference of scene documents, from their JSON Schema, and so from the fields that check them."""

from __future__ import annotations

import json
import re
from typing import Any

from physanimator.physics.document import scene_schema

from .markdown import code, escaped, number, table

__all__ = ["bounds_of", "scene_page"]

_HEAD = ("field", "title", "type", "bounds", "default", "what it says")


def scene_page() -> str:
    """Every field of a scene document, with its unit, bounds and default."""
    schema = scene_schema()
    example = _compact(json.dumps(schema["examples"][0], indent=2))
    parts = [
        "# Scene documents\n",
        f"{escaped(schema['description'])} `physanimator schema` prints the JSON Schema from which this page is made;"
        " name it under `$schema`, and an editor completes and checks what you type. **Scene Editor**, `--save-scene`"
        " and **Automatic Scene** write such documents; **Scene from JSON** and `--scene` read them. A value outside"
        " its bounds is refused in a sentence, before any work.\n",
        f"```json\n{example}\n```\n",
        "## The document\n",
        _table(schema),
    ]
    for name, definition in schema["$defs"].items():
        if "properties" in definition:
            parts.append(f"({_anchor(name)})=\n## {escaped(definition.get('title', name))}\n")
            parts.append(_table(definition))
    small = [(name, each) for name, each in schema["$defs"].items() if "properties" not in each]
    parts.append("## Small values\n")
    parts += [f"({_anchor(name)})=\n### {_title(name)}\n\n{_type(each)}{_said(each)}\n" for name, each in small]
    return "\n".join(parts)


def _compact(text: str) -> str:
    """JSON with short lists and objects on one line each."""
    for _ in range(3):
        text = re.sub(r"([\[{])\s+([^\[\]{}]{1,60}?)\s+([\]}])", lambda m: m[1] + " ".join(m[2].split()) + m[3], text)
        text = re.sub(r"\[\s+((?:\[[^\[\]]*\],?\s*)+)\]", lambda m: "[" + " ".join(m[1].split()) + "]", text)
    return text


def _table(definition: dict[str, Any]) -> str:
    required = definition.get("required", ())
    return table(_HEAD, [_row(name, each, name in required) for name, each in definition["properties"].items()])


def _row(name: str, field: dict[str, Any], required: bool) -> tuple[str, ...]:
    default = code(json.dumps(field["default"])) if "default" in field else "required" if required else ""
    return (
        code(name),
        escaped(field.get("title", "")),
        _type(field),
        bounds_of(field),
        default,
        escaped(field.get("description", "")),
    )


def _type(field: dict[str, Any]) -> str:
    if "$ref" in field:
        return _link(field)
    if "allOf" in field:
        return "one of " + ", ".join(_link(each["then"]) for each in field["allOf"] if "then" in each)
    if "enum" in field:
        return ", ".join(code(json.dumps(each)) for each in field["enum"])
    if "const" in field:
        return code(json.dumps(field["const"]))
    if "oneOf" in field or "anyOf" in field:
        return " or ".join(_type(each) for each in field.get("oneOf") or field["anyOf"])
    kinds = field.get("type", "anything")
    kinds = kinds if isinstance(kinds, list) else [kinds]
    if "array" in kinds and isinstance(field.get("items"), dict):
        return f"list of {_type(field['items'])}"
    if "array" in kinds and "prefixItems" in field:
        return "[" + ", ".join(_type(each) for each in field["prefixItems"]) + "]"
    return " or ".join(kinds)


def bounds_of(field: dict[str, Any]) -> str:
    """What a number, list or text is held to, in signs: ``> 0, <= 600``."""
    signs = (
        ("minimum", ">="),
        ("exclusiveMinimum", ">"),
        ("maximum", "<="),
        ("exclusiveMaximum", "<"),
    )
    found = [f"{sign} {number(field[key])}" for key, sign in signs if key in field]
    few, most = field.get("minItems"), field.get("maxItems")
    if few is not None or most is not None:
        found.append(f"{few or 0} to {most} entries" if most is not None else f"at least {few} entries")
    if "maxLength" in field:
        found.append(f"at most {field['maxLength']} characters")
    return escaped(", ".join(found))


def _said(field: dict[str, Any]) -> str:
    bounds = bounds_of(field)
    inner = field.get("items") if isinstance(field.get("items"), dict) else None
    each = f"; each {bounds_of(inner)}" if inner and bounds_of(inner) else ""
    text = f". {escaped(field['description'])}" if "description" in field else ""
    return f"{', ' + bounds if bounds else ''}{each}{text}"


def _link(field: dict[str, Any]) -> str:
    name = field["$ref"].rsplit("/", 1)[-1]
    return f"[{_title(name).lower()}](#{_anchor(name)})"


def _title(name: str) -> str:
    return name.replace("_", " ").capitalize()


def _anchor(name: str) -> str:
    return f"scene-{name.replace('_', '-')}"
