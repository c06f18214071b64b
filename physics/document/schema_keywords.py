"""The keywords of JSON Schema, for documents with lists of millions: in jsonschema's way, but not at its expense.

The library writes every wrong value out, a whole list too, into a message of its own, which nobody reads here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import jsonschema
from jsonschema.exceptions import ValidationError

from .quick_check import test_of

__all__ = ["SceneValidator"]

_TOGETHER = 4096  # entries of a list, of which mostly all are right


def _is_number(checker: object, value: object) -> bool:
    return type(value) is int or (type(value) is float and math.isfinite(value))


def _never(entries: Sequence[Any]) -> bool:
    return False


def _without_its_content(keyword: str) -> Callable[..., Iterator[ValidationError]]:
    """A keyword for which it does not matter what a list or an object holds."""
    check = jsonschema.Draft202012Validator.VALIDATORS[keyword]

    def check_kind(validator: Any, value: Any, instance: Any, schema: Any) -> Iterator[ValidationError]:
        empty = [] if isinstance(instance, list) else {} if isinstance(instance, dict) else instance
        yield from check(validator, value, empty, schema) or ()

    return check_kind


def _check_least(validator: Any, least: int, instance: Any, schema: Any) -> Iterator[ValidationError]:
    yield from _wrong(isinstance(instance, list) and len(instance) < least)


def _check_most(validator: Any, most: int, instance: Any, schema: Any) -> Iterator[ValidationError]:
    yield from _wrong(isinstance(instance, list) and len(instance) > most)


def _check_keys(validator: Any, allowed: bool, instance: Any, schema: Any) -> Iterator[ValidationError]:
    yield from _wrong(not allowed and isinstance(instance, dict) and not instance.keys() <= schema["properties"].keys())


def _wrong(wrong: bool) -> Iterator[ValidationError]:
    if wrong:
        yield ValidationError("")


def _check_items(validator: Any, items: dict[str, Any], instance: Any, schema: Any) -> Iterator[ValidationError]:
    """The keyword "items", with a short way through long lists whose entries are right, and none into too long ones."""
    if not isinstance(instance, list) or len(instance) > schema.get("maxItems", math.inf):
        return
    is_right = test_of(items["$ref"]) if "$ref" in items else _never
    for first in range(0, len(instance), _TOGETHER):
        entries = instance[first : first + _TOGETHER]
        if is_right(entries):
            continue
        for index, entry in enumerate(entries, first):
            if not is_right([entry]):
                yield from validator.descend(entry, items, path=index)


SceneValidator: Any = jsonschema.validators.extend(
    jsonschema.Draft202012Validator,
    validators={
        **{name: _without_its_content(name) for name in ("type", "enum", "const")},
        "minItems": _check_least,
        "maxItems": _check_most,
        "additionalProperties": _check_keys,
        "items": _check_items,
    },
    type_checker=jsonschema.Draft202012Validator.TYPE_CHECKER.redefine("number", _is_number),
)
"""Checks documents as ``jsonschema.Draft202012Validator`` does; a number is finite, true is none."""
