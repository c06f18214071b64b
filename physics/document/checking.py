"""Checks scene documents against their schema and says in a sentence what is wrong, and where."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable
from difflib import get_close_matches
from functools import lru_cache
from itertools import islice
from typing import TYPE_CHECKING, Any

from ..errors import SceneError, shown
from .encoding import SCENE_VERSION
from .quick_check import is_right
from .schema import scene_schema

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError
    from jsonschema.protocols import Validator

__all__ = ["check_document", "join_path"]

_LONGEST = 60  # characters of a value or a key that are shown
_ENOUGH = 100  # wrong values among which to choose the first

_TYPES = {
    "array": "a list",
    "boolean": "true or false",
    "integer": "a whole number",
    "null": "null",
    "number": "a number",
    "object": "an object in braces",
    "string": "a text in quotes",
}
_BOUNDS = {"minimum": "at least", "exclusiveMinimum": "above", "maximum": "at most", "exclusiveMaximum": "below"}


def check_document(data: object) -> dict[str, Any]:
    """The data, if it is a scene document of a version that can be read.

    Raises:
        SceneError: with the path of the first wrong value, in the order of the path.
    """
    if not isinstance(data, dict):
        raise SceneError("", f"a scene must be an object in braces. Got: {_shown(data)}")
    _check_version(data)
    if is_right(data):
        return data
    errors = list(islice(_validator().iter_errors(data), _ENOUGH))
    if errors:
        raise min((_described(error) for error in errors), key=lambda found: found[0])[1]
    return data


def join_path(path: str, *parts: str | int) -> str:
    """A path such as ``strokes[2].radius`` from its parts."""
    for part in parts:
        path += f"[{part}]" if isinstance(part, int) else f".{part}" if path else part
    return path


def _check_version(data: dict[str, Any]) -> None:
    version = data.get("version", SCENE_VERSION)
    if type(version) is int and version > SCENE_VERSION:
        raise SceneError(
            "version",
            f"this scene was made by a newer PhysAnimator (format {_shown(version)}, known here up to {SCENE_VERSION});"
            " update PhysAnimator to open it",
        )


@lru_cache(maxsize=1)
def _validator() -> Validator:
    from .schema_keywords import SceneValidator

    return SceneValidator(scene_schema())


def _described(error: ValidationError) -> tuple[tuple[Any, ...], SceneError]:
    """A sort key and the error for a person; an unknown key comes before the key that it may be a slip for."""
    parts = list(error.absolute_path)
    path = join_path("", *parts)
    if error.validator == "additionalProperties":
        known = error.schema["properties"]
        key = next(str(key) for key in error.instance if key not in known)
        return (parts, 0), SceneError(join_path(path, _key_shown(key)), f"is not known here; {_suggestion(key, known)}")
    if error.validator == "required":
        key = next(key for key in error.validator_value if key not in error.instance)
        return (parts, 1), SceneError(join_path(path, key), f"is missing{_possible(error.schema, key)}")
    return (parts, 2), SceneError(path, f"must {_expected(error)}. Got: {_shown(error.instance)}{_meant(error)}")


def _expected(error: ValidationError) -> str:
    """What would be right, to stand after "must"."""
    schema, rule, value = error.schema, str(error.validator), error.validator_value
    if rule in _BOUNDS:
        unit = re.search(r" \[(.+)\]$", schema.get("title", ""))
        return f"be {_BOUNDS[rule]} {value:.12g}" + (f" {unit[1]}" if unit else "")
    if rule == "type":
        allowed = " or ".join(_TYPES[name] for name in ([value] if isinstance(value, str) else value))
        infinite = isinstance(error.instance, float) and not math.isfinite(error.instance)
        return f"be {allowed}, and finite" if infinite else f"be {allowed}"
    if rule in ("minItems", "maxItems") and schema.get("minItems") == schema.get("maxItems"):
        return f"be a list of {value} numbers"
    if rule in ("minItems", "maxItems"):
        return f"have at {'least' if rule == 'minItems' else 'most'} {value} {'entry' if value == 1 else 'entries'}"
    if rule == "enum":
        return f"be one of {', '.join(map(str, value))}"
    return f"be {json.dumps(value)}"  # const


def _possible(schema: dict[str, Any], key: str) -> str:
    """The values among which a missing key chooses."""
    choices = schema["properties"][key].get("enum")
    return f"; one of {', '.join(map(str, choices))}" if choices else ""


def _meant(error: ValidationError) -> str:
    """The choice that a misspelt one may stand for."""
    if error.validator != "enum" or not isinstance(error.instance, str):
        return ""
    near = get_close_matches(error.instance[:_LONGEST].lower(), map(str, error.validator_value), n=1)
    return f" (did you mean '{near[0]}'?)" if near else ""


def _suggestion(key: str, known: Iterable[str]) -> str:
    near = get_close_matches(key[:_LONGEST].lower(), known, n=1)
    return f"did you mean '{near[0]}'?" if near else f"known are {', '.join(known)}"


def _shown(value: object) -> str:
    """A value in the document's own terms, short."""
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    if not (value is None or isinstance(value, bool | str)):
        return shown(value)
    # A long text is cut before it is quoted: some have millions of characters.
    text = json.dumps(value[: _LONGEST + 1] if isinstance(value, str) else value, ensure_ascii=False)
    return shown(text if len(text) <= _LONGEST else text[:_LONGEST] + "...")


def _key_shown(key: str) -> str:
    """An unknown key as part of a path: itself, or in quotes and short where it would tear the sentence apart."""
    return key if key.isprintable() and 0 < len(key) <= _LONGEST else _shown(key)
