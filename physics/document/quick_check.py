"""A quick way through right documents: the schema as tests of plain Python, made from it once.

They hold only for what the schema lets pass. What they turn down, jsonschema decides on, which also says what is wrong.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from functools import cache
from itertools import chain
from typing import Any

from .schema import scene_schema
from .schema_blocks import Schema

__all__ = ["Test", "is_right", "test_of"]

Test = Callable[[Sequence[Any]], bool]
"""Whether all of several values are right: one loop inside the interpreter for lists of millions."""

_FINITE = sys.float_info.max


def is_right(document: object) -> bool:
    """Whether a document surely follows the schema."""
    return _document_test()([document])


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
        return lambda values: _are(values, {int, str}) and all(value in choices for value in values)
    kind, nullable = schema["type"], False
    if isinstance(kind, list):
        (kind,), nullable = [name for name in kind if name != "null"], True
    test = _MAKERS[kind](schema)
    return (lambda values: test([value for value in values if value is not None])) if nullable else test


def _are(values: Sequence[Any], kinds: set[type]) -> bool:
    return kinds.issuperset(map(type, values))


def _simple(schema: Schema) -> Test:
    expected: set[type] = {str} if "string" in schema["type"] else {bool}
    return lambda values: _are(values, expected)


def _number(schema: Schema) -> Test:
    kinds: set[type] = {int} if "integer" in schema["type"] else {int, float}
    low, high = schema.get("minimum", -_FINITE), schema.get("maximum", _FINITE)
    above, below = schema.get("exclusiveMinimum", -math.inf), schema.get("exclusiveMaximum", math.inf)

    def test(values: Sequence[Any]) -> bool:
        if not values:
            return True
        if not _are(values, kinds):
            return False
        least, most = min(values), max(values)
        # A number that is none compares with nothing, so that least and most may pass it by; no sum does.
        return low <= least and most <= high and above < least and most < below and _is_number(values)

    return test


def _is_number(values: Sequence[Any]) -> bool:
    try:
        return math.isfinite(sum(values))
    except OverflowError:  # of whole numbers beyond all floating-point ones
        return False


def _array(schema: Schema) -> Test:
    test, least, most = _made(schema["items"]), schema.get("minItems", 0), schema.get("maxItems", sys.maxsize)

    def test_all(values: Sequence[Any]) -> bool:
        if not _are(values, {list}) or not all(least <= length <= most for length in set(map(len, values))):
            return False
        return test(values[0] if len(values) == 1 else list(chain.from_iterable(values)))

    return test_all


def _object(schema: Schema) -> Test:
    required = set(schema.get("required", ()))
    if "allOf" in schema:  # one of several typed objects
        tests = {rule["if"]["properties"]["type"]["const"]: _made(rule["then"]) for rule in schema["allOf"]}
        return lambda values: _are(values, {dict}) and all(_is_one_of(value, tests) for value in values)
    tests = {name: _made(each) for name, each in schema["properties"].items()}
    return lambda values: (
        _are(values, {dict})
        and all(required <= value.keys() <= tests.keys() for value in values)
        and all(tests[name]([each]) for value in values for name, each in value.items())
    )


def _is_one_of(value: dict[str, Any], tests: dict[str, Test]) -> bool:
    name = value.get("type")
    return type(name) is str and name in tests and tests[name]([value])


_MAKERS: dict[str, Callable[[Schema], Test]] = {
    "string": _simple,
    "boolean": _simple,
    "number": _number,
    "integer": _number,
    "array": _array,
    "object": _object,
}
