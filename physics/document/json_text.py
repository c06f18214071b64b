"""JSON as text: read without trust, and written so that a person can edit it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from ..errors import SceneError
from ..limits import (
    MAX_DIGITS,
    MAX_DOCUMENT_BYTES,
    MAX_DOCUMENT_KEYS,
    MAX_DOCUMENT_LISTS,
    MAX_DOCUMENT_OBJECTS,
    MAX_DOCUMENT_VALUES,
)
from .checking import join_path

__all__ = ["Most", "read_json", "surplus_of", "write_json"]

_LINE = 110  # characters that may stand in one line before it is broken up


@dataclass(frozen=True)
class Most:
    """How much a JSON text may hold.

    Attributes:
        values: entries of all lists and objects together.
        lists: how many.
        objects: how many.
        keys: of all objects together.
    """

    values: int = MAX_DOCUMENT_VALUES
    lists: int = MAX_DOCUMENT_LISTS
    objects: int = MAX_DOCUMENT_OBJECTS
    keys: int = MAX_DOCUMENT_KEYS


_OF_A_SCENE = Most()


class _Repeated:
    """Stands for the value of a key that an object holds twice."""


_HOLDING = {dict, list, _Repeated}


def read_json(text: str | bytes) -> Any:
    """The data that a JSON text holds.

    NaN and infinity come through as floats, for the check against the schema to name their place.

    Raises:
        SceneError: the text is too long or holds too much, is not JSON (with line and column), or holds a key twice in
            one object.
    """
    if len(text) > MAX_DOCUMENT_BYTES:
        raise SceneError("", f"the scene must be at most {MAX_DOCUMENT_BYTES >> 20} MB of text. Got: more")
    if surplus := surplus_of(text, _OF_A_SCENE):
        raise SceneError("", f"the scene must hold at most {surplus}. Got: more")
    repeating: list[dict[str, Any]] = []

    def as_object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        result = dict(pairs)
        if len(result) < len(pairs):
            result = _marked(pairs)
            repeating.append(result)
        return result

    try:
        text = text.decode("utf-8-sig") if isinstance(text, bytes) else text.removeprefix("\ufeff")
        data = json.loads(text, object_pairs_hook=as_object)
    except UnicodeDecodeError as error:
        raise SceneError("", f"the scene must be UTF-8 text. Got: {error.reason} at byte {error.start}") from error
    except json.JSONDecodeError as error:
        where = f"line {error.lineno}, column {error.colno}"
        raise SceneError("", f"the scene is not JSON: {where}: {error.msg}") from error
    except RecursionError as error:
        raise SceneError("", "the scene must not be nested this deep") from error
    except ValueError as error:  # a whole number of thousands of digits
        raise SceneError("", f"the scene holds an unreadable number: {error}") from error
    if repeating:
        _refuse_repeated_keys(data)
    return data


def surplus_of(text: str | bytes, most: Most) -> str | None:
    """Of what a JSON text holds more than it may, such as "100,000 objects", told from its signs before it is read.

    A sign that stands in quotes counts as well: no honest text comes near the bounds.

    Args:
        text: JSON, or something else.
        most: the bounds.
    """
    bounds = (",", most.values, "values"), ("[", most.lists, "lists"), ("{", most.objects, "objects")
    for sign, bound, plural in (*bounds, (":", most.keys, "keys")):
        if (text.count(sign) if isinstance(text, str) else text.count(sign.encode())) > bound:
            return f"{bound:,} {plural}"
    half = MAX_DIGITS // 2
    # Of so many digits in a row, one of these pieces of half as many consists.
    if any(text[first : first + half].isdigit() for first in range(0, len(text) - half + 1, half)):
        return f"{MAX_DIGITS:,} digits a number"
    return None


def write_json(data: Any) -> str:
    """JSON text in which short things stand on one line and long lists fill their lines.

    Raises:
        SceneError: the text would be too long to be read again.
    """
    text = _written(data, 0) + "\n"
    if len(text.encode("utf-8", "surrogatepass")) > MAX_DOCUMENT_BYTES:
        raise SceneError("", f"the scene must be at most {MAX_DOCUMENT_BYTES >> 20} MB of text. Got: more")
    if surplus := surplus_of(text, _OF_A_SCENE):
        raise SceneError("", f"the scene must hold at most {surplus}. Got: more")
    return text


def _marked(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for key, value in pairs:
        result[key] = _Repeated() if key in result else value
    return result


def _refuse_repeated_keys(data: Any) -> None:
    # The way to where the walk is, not one to each of millions of places.
    way: list[str | int] = []
    walks = [_holding(data)]
    while walks:
        for key, value in walks[-1]:
            way[len(walks) - 1 :] = [key]
            if isinstance(value, _Repeated):
                raise SceneError(join_path("", *way), "stands twice in the same object; keep one")
            if _holds(value):
                walks.append(_holding(value))
                break
        else:
            walks.pop()


def _holds(value: Any) -> bool:
    return not _HOLDING.isdisjoint(map(type, value.values() if isinstance(value, dict) else value))


def _holding(value: Any) -> Iterator[tuple[str | int, Any]]:
    """What is in an object or a list; numbers and texts are passed over at once."""
    entries = value.items() if isinstance(value, dict) else enumerate(value)
    return ((key, each) for key, each in entries if type(each) in _HOLDING)


def _written(value: Any, indent: int, *, used: int = 0) -> str:
    """A value as text, its first line after ``indent + used`` characters and its others at the indent."""
    flat = json.dumps(value, ensure_ascii=False, allow_nan=False)
    if indent + used + len(flat) < _LINE or not isinstance(value, dict | list):
        return flat
    if isinstance(value, dict):
        keys = [json.dumps(key, ensure_ascii=False) + ": " for key in value]
        entries = [key + _written(v, indent + 2, used=len(key)) for key, v in zip(keys, value.values(), strict=True)]
    elif any(isinstance(entry, dict) for entry in value):
        entries = [_written(entry, indent + 2) for entry in value]
    else:
        entries = _filled([json.dumps(entry) for entry in value], indent + 2)
    opening, closing = "{}" if isinstance(value, dict) else "[]"
    margin = "\n" + " " * indent
    return opening + ",".join(f"{margin}  {entry}" for entry in entries) + margin + closing


def _filled(entries: list[str], indent: int) -> list[str]:
    """Entries joined to lines."""
    lines = [entries[0]]
    for entry in entries[1:]:
        if len(lines[-1]) + len(entry) + indent < _LINE:
            lines[-1] += ", " + entry
        else:
            lines.append(entry)
    return lines
