"""A quick way through right documents: the schema as tests of plain Python, made from it once.

They hold only for what the schema lets pass. What they turn down, jsonschema decides on, which also says what is wrong.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from functools import cache
from typing import Any

from .schema import scene_schema
from .schema_blocks import Schema

__all__ = ["is_right", "test_of"]

Test = Callable[[Any], bool]

_FINITE = sys.float_info.max


def is_right(document: object) -> bool:
    """Whether a document surely follows the schema."""
    return _document_test()(document)


@cache
def test_of(reference: str) -> Test:
    """The test for what is defined in the schema under a reference such as "#/$defs/point"."""
    return _made(scene_schema()["$defs"][reference.removeprefix("#/$defs/")])


@cache
def _document_test() -> Test:
    return _made(scene_schema())


def _made(schema: Schema) -> Test:
    if "$ref" in schema:
        return test_of(schema["$ref"])
    if "enum" in schema or "const" in schema:
        choices = schema.get("enum", [schema.get("const")])
        return lambda value: type(value) in (int, str) and value in choices
    kind, nullable = schema["type"], False
    if isinstance(kind, list):
        (kind,), nullable = [name for name in kind if name != "null"], True
    test = _MAKERS[kind](schema)
    return (lambda value: value is None or test(value)) if nullable else test


def _simple(schema: Schema) -> Test:
    expected = str if "string" in schema["type"] else bool
    return lambda value: type(value) is expected


def _number(schema: Schema) -> Test:
    kinds = (int,) if "integer" in schema["type"] else (int, float)
    low, high = schema.get("minimum", -_FINITE), schema.get("maximum", _FINITE)
    above, below = schema.get("exclusiveMinimum", -math.inf), schema.get("exclusiveMaximum", math.inf)
    return lambda value: type(value) in kinds and low <= value <= high and above < value < below


def _array(schema: Schema) -> Test:
    test, least, most = _made(schema["items"]), schema.get("minItems", 0), schema.get("maxItems", sys.maxsize)
    return lambda value: type(value) is list and least <= len(value) <= most and all(map(test, value))


def _object(schema: Schema) -> Test:
    required = set(schema.get("required", ()))
    if "allOf" in schema:  # one of several typed objects
        tests = {rule["if"]["properties"]["type"]["const"]: _made(rule["then"]) for rule in schema["allOf"]}
        return lambda value: type(value) is dict and _is_one_of(value, tests)
    tests = {name: _made(each) for name, each in schema["properties"].items()}
    return lambda value: (
        type(value) is dict
        and required <= value.keys() <= tests.keys()
        and all(tests[name](each) for name, each in value.items())
    )


def _is_one_of(value: dict[str, Any], tests: dict[str, Test]) -> bool:
    name = value.get("type")
    return type(name) is str and name in tests and tests[name](value)


_MAKERS: dict[str, Callable[[Schema], Test]] = {
    "string": _simple,
    "boolean": _simple,
    "number": _number,
    "integer": _number,
    "array": _array,
    "object": _object,
}
