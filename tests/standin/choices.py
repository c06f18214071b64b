"""A node's inputs under the values that a prompt gives: what a chosen option brings, and how it is handed over."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

__all__ = ["Described", "described", "is_link", "nested"]

_DYNAMIC = "COMFY_DYNAMICCOMBO_V3"


class Described(NamedTuple):
    """Inputs in full, such as ``renderer.sketches``.

    Attributes:
        required: type and options by name.
        optional: the same.
        paths: for what belongs to a dynamic choice, where in the value it is put.
    """

    required: dict[str, Any]
    optional: dict[str, Any]
    paths: dict[str, str]

    @property
    def all(self) -> dict[str, Any]:
        return self.required | self.optional


def is_link(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 2 and isinstance(value[0], str) and isinstance(value[1], int)


def described(inputs: Mapping[str, Any], given: Mapping[str, Any]) -> Described:
    """The inputs that a node has under these values; a dynamic one with no known choice is left out."""
    found = Described({}, {}, {})
    _collect(inputs, given, "", found)
    return found


def _collect(inputs: Mapping[str, Any], given: Mapping[str, Any], prefix: str, found: Described) -> None:
    for group, into in (("required", found.required), ("optional", found.optional)):
        for name, (kind, *options) in inputs.get(group, {}).items():
            full, value = prefix + name, (kind, options[0] if options else {})
            if kind == _DYNAMIC:
                chosen = next((each for each in value[1]["options"] if each["key"] == given.get(full)), None)
                if chosen is None:
                    continue
                _collect(chosen["inputs"], given, f"{full}.", found)
                found.paths[full] = f"{full}.{name}"
            elif prefix:
                found.paths[full] = full
            into[full] = value


def nested(values: Mapping[str, Any], paths: Mapping[str, str]) -> dict[str, Any]:
    """The values as a node gets them: what belongs to a dynamic choice in a dictionary under its name."""
    flat, result = dict(values), {}
    for name, path in paths.items():
        *above, last = path.split(".")
        place: dict[str, Any] = result
        for part in above:
            place = place.setdefault(part, {})
        place[last] = flat.pop(name, None)
    return flat | result
