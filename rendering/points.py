"""Points and paths that a person clicked or drew, from the text in which editors hand them over."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..physics.errors import InvalidInputError, require
from ..physics.limits import MAX_PARTS
from ..physics.query_points import QueryPoint

__all__ = ["QueryPoint", "parse_points", "parse_polyline"]

_POINT_FORMS = '{"x": .., "y": ..}, [x, y], [x, y, label] or [x, y, label, part]'
_LABELS = {1: True, 0: False, "1": True, "0": False, "positive": True, "negative": False}


def parse_points(points: str | Sequence[Any] | Mapping[str, Any], *, width: int, height: int) -> list[QueryPoint]:
    """Query points from text or from already decoded JSON, in pixels.

    Understood are JSON lists of ``{"x", "y"}`` with an optional ``"label"`` (1 on the object, 0 beside it) and
    ``"part"`` (its number, from 0), of ``[x, y]``, ``[x, y, label]`` or ``[x, y, label, part]``, an object
    ``{"positive": [...], "negative": [...]}``, and plain text with one ``x,y`` or ``x,y,label`` a line. A point
    without a label is positive, one without a part belongs to part 0. A scene document gives its ``query_points``,
    scaled to the picture.

    Args:
        points: the text, or the decoded list or object.
        width: width of the picture [px].
        height: height of the picture [px].

    Raises:
        InvalidInputError: the text is neither, a point is incomplete, or one lies outside the picture.
    """
    data = _decode(points, "points")
    if isinstance(data, Mapping) and {"version", "query_points"} & data.keys():
        found = _from_document(data, width, height)
    elif isinstance(data, Mapping) and not {"x", "y"} <= data.keys():
        found = _from_groups(data)
    else:
        items = [data] if isinstance(data, Mapping) else data
        found = [_query_point(item, f"points[{index}]") for index, item in enumerate(_one_spline(items, "points"))]
    for index, point in enumerate(found):
        if not (0 <= point.x <= width and 0 <= point.y <= height):
            raise InvalidInputError(
                f"points[{index}] must lie inside the picture of {width} x {height} px. Got: ({point.x:g}, {point.y:g})"
            )
    return found


def parse_polyline(path: str | Sequence[Any], *, name: str = "path") -> list[tuple[float, float]]:
    """The points of one drawn path in pixels; they may lie outside the picture.

    Understood are JSON lists of ``{"x", "y"}`` or ``[x, y]``, either of them inside a list of one spline, JSON
    text within JSON text, as spline editors produce it, and plain text with one ``x,y`` a line.

    Args:
        path: the text, or the decoded list.
        name: what the user calls the path, for messages.

    Raises:
        InvalidInputError: the text is not a path, holds several, or a point is incomplete.
    """
    items = _one_spline(_decode(path, name), name)
    require(name, "no points", len(items) > 0, "at least one point")
    return [_coordinates(item, f"{name}[{index}]") for index, item in enumerate(items)]


def _decode(value: Any, name: str) -> Any:
    """Lists as they are, JSON text decoded as often as it is wrapped, other text as lines of numbers."""
    while isinstance(value, str):
        text = value.strip()
        require(name, "empty text", bool(text), f"a list of points such as {_POINT_FORMS}")
        value = _json_or_none(text)
        if value is None:
            value = _from_lines(text, name)
    expected = f"a list of points such as {_POINT_FORMS}"
    require(name, value, isinstance(value, Sequence | Mapping | np.ndarray), expected)
    return value.tolist() if isinstance(value, np.ndarray) else value


def _json_or_none(text: str) -> Any:
    for candidate in (text, text.replace("'", '"')):
        try:
            return json.loads(candidate)
        except json.JSONDecodeError:
            continue
    return None


def _from_lines(text: str, name: str) -> list[list[str]]:
    if text[0] in "[{\"'":
        raise InvalidInputError(f"{name} must be valid JSON, a list of points such as {_POINT_FORMS}. Got: {text[:60]}")
    lines = [line.split("#")[0].strip() for line in re.split(r"[\n;]", text)]
    return [re.split(r"\s*[,\t ]\s*", line) for line in lines if line]


def _one_spline(items: Any, name: str) -> Sequence[Any]:
    """The points, whether they come bare or inside a list of one spline."""
    require(name, items, not isinstance(items, Mapping), f"a list of points such as {_POINT_FORMS}")
    splines = [_decode(item, name) if _is_wrapped(item) else item for item in items]
    if not splines or not all(_is_spline(item) for item in splines):
        return splines
    require(name, f"{len(splines)} paths", len(splines) == 1, "one path")
    return _one_spline(splines[0], name)


def _is_wrapped(item: Any) -> bool:
    return isinstance(item, str) and item.strip()[:1] in ("[", "{")


def _is_spline(item: Any) -> bool:
    return (
        isinstance(item, Sequence)
        and len(item) > 0
        and isinstance(item[0], Sequence | Mapping | np.ndarray)
        and not isinstance(item[0], str)
    )


def _from_groups(data: Mapping[str, Any]) -> list[QueryPoint]:
    unknown = set(data) - {"positive", "negative"}
    require("points", data, not unknown and bool(data), 'a list, or an object with "positive" and "negative"')
    found = []
    for group, positive in (("positive", True), ("negative", False)):
        items = data.get(group) or []
        for index, item in enumerate(_one_spline(_decode(items, group), group)):
            name = f"{group}[{index}]"
            x, y = _coordinates(item, name)
            found.append(QueryPoint(x, y, positive, _part(item, name)))
    return found


def _from_document(data: Mapping[str, Any], width: int, height: int) -> list[QueryPoint]:
    from ..physics.scene_checking import check_document
    from ..physics.scene_json import query_points_of

    document = check_document(dict(data))
    scale = (width / document["width"], height / document["height"], 1.0)
    return [point.rescaled(scale) for point in query_points_of(document)]


def _query_point(item: Any, name: str) -> QueryPoint:
    x, y = _coordinates(item, name)
    label: Any = 1
    if isinstance(item, Mapping):
        label = item.get("label", 1)
    elif len(item) > 2:
        label = item[2]
    label = label.strip().lower() if isinstance(label, str) else label
    known = isinstance(label, str | int | float) and label in _LABELS
    require(f"{name} label", label, known, "1 (on the object) or 0 (beside it)")
    return QueryPoint(x, y, _LABELS[label], _part(item, name))


def _part(item: Any, name: str) -> int:
    given: Any = item.get("part", 0) if isinstance(item, Mapping) else item[3] if len(item) == 4 else 0
    try:
        part = float(given)
    except (TypeError, ValueError):
        part = -1.0
    require(f"{name} part", given, part in range(MAX_PARTS), f"a whole number from 0 to {MAX_PARTS - 1}")
    return int(part)


def _coordinates(item: Any, name: str) -> tuple[float, float]:
    if isinstance(item, Mapping) and {"x", "y"} <= item.keys():
        values = (item["x"], item["y"])
    elif isinstance(item, Sequence | np.ndarray) and not isinstance(item, str) and len(item) in (2, 3, 4):
        values = (item[0], item[1])
    else:
        raise InvalidInputError(f"{name} must be {_POINT_FORMS}. Got: {item}")
    try:
        x, y = (float(value) for value in values)
    except (TypeError, ValueError):
        raise InvalidInputError(f"{name} must hold two numbers. Got: {item}") from None
    require(name, item, bool(np.isfinite((x, y)).all()), "finite pixel coordinates")
    return x, y
