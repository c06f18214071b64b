"""Sets as TOML files: read without trust, and refused in one sentence that says where."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from ...physics.errors import InvalidInputError, shown
from ..files import parsed_toml, read_text_file
from .evaluation_set import EvaluationSet, PictureOfSet, Weights
from .methods import Method
from .names import suggestion

__all__ = ["BUNDLED_SET", "read_set"]

BUNDLED_SET = Path(__file__).resolve().parents[2] / "workflows" / "drawn_set" / "set.toml"
"""Illustrations of several kinds that were drawn for this project; its methods need no weights."""

_LARGEST_FILE = 1 << 20
_KINDS = {
    "string_type": "text in quotes",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "int_parsing_size": "a whole number of fewer digits",
    "float_type": "a number",
    "bool_type": "true or false",
    "tuple_type": "a list",
    "dataclass_type": "a table",
    "dict_type": "a table",
}
_PATHS_OF_PICTURES = ("image", "scene", "plate", "in_front")


def read_set(path: Path) -> EvaluationSet:
    """The set in a file, with absolute paths.

    Args:
        path: a TOML file.

    Raises:
        InvalidInputError: it is missing, no TOML, or says what cannot be; the message names the place in it.
    """
    told = _read(path)
    if isinstance(told.get("methods"), list):
        told = told | {"methods": [{"name": each} if isinstance(each, str) else each for each in told["methods"]]}
    try:
        text = json.dumps(told)
    except (TypeError, ValueError, RecursionError):
        raise InvalidInputError(f"{path} must hold text, numbers, lists and tables. Got: a date or the like") from None
    try:
        found = TypeAdapter(EvaluationSet).validate_json(text)
    except ValidationError as error:
        raise InvalidInputError(f"{path}: {_sentence(error)}") from None
    return _placed(found, path.absolute().parent)


def _read(path: Path) -> dict[str, Any]:
    return parsed_toml(read_text_file(path, "SET", most=_LARGEST_FILE), path, "SET")


def _sentence(error: ValidationError) -> str:
    """The first thing that is wrong, in one sentence."""
    first = error.errors(include_url=False)[0]
    where, got = _where(first["loc"]), first["input"]
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, InvalidInputError):
        return f"{where}: {cause}" if where else str(cause)
    if first["type"] in ("unexpected_keyword_argument", "extra_forbidden"):
        known = _keys_at(first["loc"][:-1])
        name = str(first["loc"][-1])
        inside = f"{_where(first['loc'][:-1])} must" if len(first["loc"]) > 1 else "a set must"
        return f"{inside} have no other keys than {', '.join(known)}{suggestion(name, known)}. Got: {shown(name)}"
    if first["type"] == "missing":
        return f"{where} must be given. Got: nothing"
    kind = _KINDS.get(first["type"], "such that it can be read")
    return f"{where} must be {kind}. Got: {shown(got)}"


def _where(place: Sequence[str | int]) -> str:
    return "".join(f"[{each}]" if isinstance(each, int) else f".{each}" for each in place).lstrip(".")


def _keys_at(place: Sequence[str | int]) -> list[str]:
    kinds: Mapping[str, type] = {"pictures": PictureOfSet, "methods": Method, "weights": Weights}
    kind = kinds.get(str(place[0]), EvaluationSet) if place else EvaluationSet
    return [each.name for each in fields(kind)]


def _placed(found: EvaluationSet, folder: Path) -> EvaluationSet:
    """The set with absolute paths."""

    def at(given: str) -> str:
        return str(folder / given) if given else ""

    def each_at(given: Iterable[str]) -> tuple[str, ...]:
        return tuple(map(at, given))

    def of_picture(each: PictureOfSet) -> PictureOfSet:
        single: dict[str, Any] = {name: at(getattr(each, name)) for name in _PATHS_OF_PICTURES}
        return replace(each, masks=each_at(each.masks), points=each_at(each.points), **single)

    pictures = tuple(map(of_picture, found.pictures))
    methods = tuple(replace(each, clips=at(each.clips)) if each.clips else each for each in found.methods)
    weights = replace(found.weights, **{name: at(str(path)) for name, path in found.weights.named.items()})
    return replace(found, pictures=pictures, methods=methods, weights=weights)
