"""Text in which editors and people write points, as lists and objects: JSON, Python's literals, or a table."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import InvalidInputError, require, shown
from ..limits import MAX_DOCUMENT_BYTES, MAX_DOCUMENT_LISTS
from .json_text import Most, surplus_of

__all__ = ["POINT_FORMS", "decoded"]

POINT_FORMS = '{"x": .., "y": ..}, [x, y], [x, y, label] or [x, y, label, part]'

_DEEPEST = 40  # a scene document needs 8
_LONGEST_LITERAL = 2**20  # characters: Python's parser takes 200 bytes for each
_MOST_WRAPPINGS = 8  # JSON text within JSON text
_LONGEST_TABLE, _LONGEST_LINE = 2**20, 1000  # characters
_COLUMNS = ("x", "y", "label", "part")


def decoded(value: Any, name: str) -> Any:
    """Lists and objects as they are; text as what it says, as often as it is wrapped in JSON text.

    Args:
        value: text, a list, an object or an array.
        name: what the user calls the points, for messages.

    Raises:
        InvalidInputError: it is none of these, too long, nested too deep, or text of another kind.
    """
    expected = f"a list of points such as {POINT_FORMS}"
    for _ in range(_MOST_WRAPPINGS):
        if not isinstance(value, str):
            break
        text = value.strip().lstrip("\ufeff").strip()
        require(name, "empty text", bool(text), expected)
        require(name, "more", len(text) <= MAX_DOCUMENT_BYTES, f"at most {MAX_DOCUMENT_BYTES >> 20} MB of text")
        value = _structured(text, name) if text[0] in "[{('\"" else _number_or_table(text, name)
    value = value.tolist() if isinstance(value, np.ndarray) else value
    if isinstance(value, Mapping):
        value = {key: each.tolist() if isinstance(each, np.ndarray) else each for key, each in value.items()}
    right = isinstance(value, Sequence | Mapping) and not isinstance(value, str | bytes)
    require(name, value, right, expected)
    return value


def _structured(text: str, name: str) -> Any:
    surplus = surplus_of(text, Most()) if len(text) > _LONGEST_LITERAL else None
    if not surplus and max(map(text.count, "()]}")) > MAX_DOCUMENT_LISTS:
        surplus = f"{MAX_DOCUMENT_LISTS:,} brackets"
    if surplus:
        raise InvalidInputError(f"{name} must hold at most {surplus}. Got: more")
    if _depth(text) > _DEEPEST:
        raise InvalidInputError(f"{name} must not be nested deeper than {_DEEPEST} lists. Got: {shown(text)}")
    for attempt in _attempts(text):
        try:
            found = attempt()
        except (ValueError, SyntaxError, TypeError, MemoryError, RecursionError):
            continue
        if found is not None:
            return list(found) if isinstance(found, tuple) else found
    if text[0] in "\"'":
        return _table(text, name)
    raise InvalidInputError(f"{name} must be valid JSON, a list of points such as {POINT_FORMS}. Got: {shown(text)}")


def _attempts(text: str) -> Iterator[Any]:
    """Ways to read text with brackets: as JSON, as Python, and as JSON with the slips that people make."""
    yield lambda: json.loads(text)
    if len(text) > _LONGEST_LITERAL:
        return
    yield lambda: ast.literal_eval(text)
    neat = re.sub(r",(\s*[\]}])", r"\1", text.replace("'", '"').rstrip(",; \n"))
    yield lambda: json.loads(neat)
    lines = ",".join(line.strip().rstrip(",;") for line in neat.splitlines() if line.strip())
    yield lambda: json.loads(f"[{lines}]")


def _depth(text: str) -> int:
    depth = deepest = 0
    for bracket in re.findall(r"[\[{(\]})]", text):
        depth += 1 if bracket in "[{(" else -1
        deepest = max(deepest, depth)
        if deepest > _DEEPEST:
            break
    return deepest


def _number_or_table(text: str, name: str) -> Any:
    """A bare number, which is no list of points, or a row for each point."""
    _require_table(text, name)
    try:
        return float(text)
    except ValueError:
        return _table(text, name)


def _require_table(text: str, name: str) -> None:
    require(name, "more", len(text) <= _LONGEST_TABLE, f"a table of at most {_LONGEST_TABLE >> 20} MB")


def _table(text: str, name: str) -> list[Any]:
    """Rows of numbers between commas, semicolons, tabs or blanks; a line of names may stand first."""
    _require_table(text, name)
    lines = [line.split("#")[0].split("//")[0].strip() for line in text.splitlines()]
    lines = [line for line in lines if line]
    longest = max(map(len, lines), default=0)
    require(name, f"one of {longest:,}", longest <= _LONGEST_LINE, f"lines of at most {_LONGEST_LINE} characters")
    if not all(re.fullmatch(r"[^\s,;]+(\s*;\s*[^\s,;]*)+", line) for line in lines):
        lines = [part.strip() for line in lines for part in line.split(";") if part.strip()]
    rows = [_cells(line) for line in lines]
    names = [cell.lower() for cell in rows[0]] if rows else []
    if {"x", "y"} <= set(names):
        unknown = [index for index, each in enumerate(names) if each not in _COLUMNS]
        return [
            {names[index]: cell for index, cell in enumerate(row) if index < len(names) and index not in unknown}
            for row in rows[1:]
        ]
    return [row[0] if len(row) == 1 else row for row in rows]


def _cells(line: str) -> list[str]:
    cells = [cell.strip("\"' ") for cell in re.split(r"\s*[,;\t ]\s*", line)]
    while cells and not cells[-1]:
        cells.pop()
    return cells
