"""JSON as text: read without trust, and written so that a person can edit it."""

from __future__ import annotations

import json
from typing import Any

from ..errors import SceneError
from ..limits import MAX_DOCUMENT_BYTES

__all__ = ["read_json", "write_json"]

_LINE = 110  # characters that may stand in one line before it is broken up


class _Repeated:
    """Stands for the value of a key that an object holds twice."""


_HOLDING = {dict, list, _Repeated}


def read_json(text: str | bytes) -> Any:
    """The data that a JSON text holds.

    NaN and infinity come through as floats, for the check against the schema to name their place.

    Raises:
        SceneError: the text is too long, is not JSON (with line and column), or holds a key twice in one object.
    """
    if len(text) > MAX_DOCUMENT_BYTES:
        raise SceneError("", f"the scene must be at most {MAX_DOCUMENT_BYTES >> 20} MB of text. Got: more")
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


def write_json(data: Any) -> str:
    """JSON text in which short things stand on one line and long lists fill their lines.

    Raises:
        SceneError: the text would be too long to be read again.
    """
    text = _written(data, 0) + "\n"
    if len(text.encode("utf-8", "surrogatepass")) > MAX_DOCUMENT_BYTES:
        raise SceneError("", f"the scene must be at most {MAX_DOCUMENT_BYTES >> 20} MB of text. Got: more")
    return text


def _marked(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for key, value in pairs:
        result[key] = _Repeated() if key in result else value
    return result


def _refuse_repeated_keys(data: Any) -> None:
    pending = [("", data)]
    while pending:
        path, value = pending.pop()
        if isinstance(value, _Repeated):
            raise SceneError(path, "stands twice in the same object; keep one")
        # Numbers and texts are passed over at once: there may be millions of them.
        if isinstance(value, dict):
            pending += [(f"{path}.{key}" if path else key, v) for key, v in value.items() if type(v) in _HOLDING]
        else:
            pending += [(f"{path}[{index}]", v) for index, v in enumerate(value) if type(v) in _HOLDING]


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
