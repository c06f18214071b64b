"""Points and paths that a person clicked or drew, from the text in which editors hand them over."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import InvalidInputError, counted, require, shown
from ..limits import MAX_PARTS, MAX_POINTS, MAX_QUERY_POINTS
from ..scene import QueryPoint
from .point_syntax import POINT_FORMS, decoded

__all__ = ["QueryPoint", "parse_points", "parse_polyline", "require_pixels"]

_ON = ("1", "1.0", "true", "positive", "pos", "+", "fg", "foreground", "on", "yes", "include")
_BESIDE = ("0", "0.0", "false", "negative", "neg", "-", "bg", "background", "off", "no", "exclude")
_LABELS = {**dict.fromkeys(_ON, True), **dict.fromkeys(_BESIDE, False)}

_POSITIVE = ("positive", "coordinates_positive", "positive_coords")
_NEGATIVE = ("negative", "coordinates_negative", "negative_coords")
_PLACES, _MARKS = ("points", "point_coords"), ("labels", "point_labels")
_NORMALISED = ("normalised", "normalized")
_GROUPS = 'a list, or an object with "positive" and "negative", or with "points" and "labels"'
_INSTEAD = ', or write {"normalised": true, "points": [...]}'
_DEEPEST = 8  # lists of one list around the points


def parse_points(points: str | Sequence[Any] | Mapping[str, Any], *, width: int, height: int) -> list[QueryPoint]:
    r"""Query points from text or from already decoded JSON, in pixels.

    Understood are, as JSON or as Python writes them:

    - lists of ``{"x", "y"}`` with an optional ``"label"`` (1 on the object, 0 beside it) and ``"part"`` (its number,
      from 0), of ``[x, y]``, ``[x, y, label]`` or ``[x, y, label, part]``;
    - an object ``{"positive": [...], "negative": [...]}`` or, as point editors of ComfyUI name them,
      ``{"coordinates_positive": [...], "coordinates_negative": [...]}``;
    - Segment Anything's ``{"points": [...], "labels": [...]}`` or ``{"point_coords", "point_labels"}``;
    - any of these objects with ``"normalised": true``, whose coordinates are 0 to 1 of the picture's width and height;
    - a table with one ``x,y`` or ``x,y,label`` a line, between commas, semicolons, tabs or blanks, a line of names
      such as ``x,y,label`` first or not, comments after ``#``;
    - a scene document, whose ``query_points`` are scaled to the picture.

    A point without a label is positive, one without a part belongs to part 0.

    Args:
        points: the text, or the decoded list or object.
        width: width of the picture [px].
        height: height of the picture [px].

    Raises:
        InvalidInputError: it is none of these, a point is incomplete or lies outside the picture, or all lie within
            its first pixel, as normalised ones do that do not say so.

    Examples:
        >>> from physanimator.physics.document import parse_points
        >>> [(point.x, point.positive) for point in parse_points("10,20\n30,20,0", width=40, height=40)]
        [(10.0, True), (30.0, False)]
    """
    data = decoded(points, "points")
    if isinstance(data, Mapping) and {"version", "query_points"} & data.keys():
        found = _from_document(data, width, height)
    elif isinstance(data, Mapping) and not {"x", "y"} <= data.keys():
        found = _from_object(data, width, height)
    else:
        found = _listed([data] if isinstance(data, Mapping) else data, "points")
        require_pixels("points", [(point.x, point.y) for point in found], instead=_INSTEAD)
    require("points", counted(len(found), "point"), len(found) <= MAX_QUERY_POINTS, f"at most {MAX_QUERY_POINTS}")
    for index, point in enumerate(found):
        if not (0 <= point.x <= width and 0 <= point.y <= height):
            raise InvalidInputError(
                f"points[{index}] must lie inside the picture of {width} x {height} px. Got: ({point.x:g}, {point.y:g})"
            )
    return found


def parse_polyline(
    path: str | Sequence[Any], *, name: str = "path", offsets: bool = False
) -> list[tuple[float, float]]:
    """The points of one drawn path in pixels; they may lie outside the picture.

    Understood are lists of ``{"x", "y"}`` or ``[x, y]``, either of them inside a list of one spline, JSON text within
    JSON text, as spline editors produce it, and a table with one ``x,y`` a line; see :func:`parse_points`.

    Args:
        path: the text, or the decoded list.
        name: what the user calls the path, for messages.
        offsets: whether the points say how far something moves, so that all may lie within a pixel.

    Raises:
        InvalidInputError: the text is not a path, holds several, a point is incomplete, or several lie within the first
            pixel, as normalised ones do.

    Examples:
        >>> from physanimator.physics.document import parse_polyline
        >>> parse_polyline("0,30; 60,30")
        [(0.0, 30.0), (60.0, 30.0)]
    """
    items = _one_spline(decoded(path, name), name)
    require(name, "no points", len(items) > 0, "at least one point")
    require(name, counted(len(items), "point"), len(items) <= MAX_POINTS, f"at most {MAX_POINTS} points")
    found = [_coordinates(item, f"{name}[{index}]") for index, item in enumerate(items)]
    if len(found) > 1 and not offsets:
        require_pixels(name, found, instead=_INSTEAD)
    return found


def require_pixels(name: str, places: Sequence[tuple[float, float]], *, instead: str = "") -> None:
    """Refuse coordinates that are all within the first pixel, as normalised ones are.

    Args:
        name: what the user calls them.
        places: x and y of each.
        instead: what else may be written, for the message.

    Raises:
        InvalidInputError: all are from 0 to 1, and not whole.
    """
    values = [value for place in places for value in place]
    normalised = bool(values) and all(0 <= value <= 1 for value in values) and any(0 < value < 1 for value in values)
    if normalised:
        raise InvalidInputError(
            f"{name} must be pixels; if these are normalised, multiply x by the picture's width and y by its height"
            f"{instead}. Got: all from 0 to 1, as ({values[0]:g}, {values[1]:g})"
        )


def _one_spline(items: Any, name: str) -> Sequence[Any]:
    """The points, whether they come bare, or as a single one, or inside a list of one spline."""
    for _ in range(_DEEPEST):
        require(name, "an object", not isinstance(items, Mapping), f"a list of points such as {POINT_FORMS}")
        if len(items) in (2, 3, 4) and all(_is_number(item) for item in items):
            return [items]
        items = [decoded(item, name) if _is_wrapped(item) else item for item in items]
        if not items or not all(_is_spline(item) for item in items):
            return items
        require(name, counted(len(items), "path"), len(items) == 1, "one path")
        items = items[0]
    raise InvalidInputError(f"{name} must be a list of points such as {POINT_FORMS}. Got: lists within lists")


def _is_nothing(value: Any) -> bool:
    return value is None or (isinstance(value, str | Sequence | Mapping | np.ndarray) and len(value) == 0)


def _is_number(item: Any) -> bool:
    return isinstance(item, int | float | np.number) and not isinstance(item, bool)


def _is_wrapped(item: Any) -> bool:
    return isinstance(item, str) and item.strip()[:1] in ("[", "{")


def _is_spline(item: Any) -> bool:
    return (
        isinstance(item, Sequence | np.ndarray)
        and not isinstance(item, str)
        and len(item) > 0
        and isinstance(item[0], Sequence | Mapping | np.ndarray)
        and not isinstance(item[0], str)
    )


def _listed(items: Any, name: str) -> list[QueryPoint]:
    return [_query_point(item, f"{name}[{index}]") for index, item in enumerate(_few(_one_spline(items, name), name))]


def _few(items: Sequence[Any], name: str) -> Sequence[Any]:
    """The items, counted before any is looked at: hundreds of thousands would take seconds."""
    require(name, counted(len(items), "point"), len(items) <= MAX_QUERY_POINTS, f"at most {MAX_QUERY_POINTS}")
    return items


def _from_object(data: Mapping[str, Any], width: int, height: int) -> list[QueryPoint]:
    unknown = set(data) - {*_POSITIVE, *_NEGATIVE, *_PLACES, *_MARKS, *_NORMALISED}
    require("points", f"an object with {shown(', '.join(map(str, data)))}", not unknown and bool(data), _GROUPS)
    if any(name in data for name in _PLACES):
        found = _from_prompt(data)
    else:
        found = [*_of_group(data, _POSITIVE, True), *_of_group(data, _NEGATIVE, False)]
    if any(data.get(name) for name in _NORMALISED):
        return [QueryPoint(each.x * width, each.y * height, each.positive, each.part) for each in found]
    require_pixels("points", [(point.x, point.y) for point in found], instead=_INSTEAD)
    return found


def _of_group(data: Mapping[str, Any], names: Sequence[str], positive: bool) -> list[QueryPoint]:
    found = []
    for group in (name for name in names if not _is_nothing(data.get(name))):
        for index, item in enumerate(_few(_one_spline(decoded(data[group], group), group), group)):
            name = f"{group}[{index}]"
            x, y = _coordinates(item, name)
            found.append(QueryPoint(x, y, positive, _part(item, name)))
    return found


def _from_prompt(data: Mapping[str, Any]) -> list[QueryPoint]:
    """Points and their labels in two lists."""
    places = next(data[name] for name in _PLACES if name in data)
    marks = next((data[name] for name in _MARKS if not _is_nothing(data.get(name))), None)
    found = [] if _is_nothing(places) else _listed(decoded(places, "points"), "points")
    if marks is None:
        return found
    labels = decoded(marks, "labels")
    while len(labels) == 1 and isinstance(labels, Sequence) and isinstance(labels[0], Sequence | np.ndarray):
        labels = decoded(labels[0], "labels")
    require("labels", labels, isinstance(labels, Sequence), "a list")
    require("labels", f"{len(labels)}", len(labels) == len(found), f"one for each of {len(found)} points")
    return [
        QueryPoint(each.x, each.y, _label(label, f"labels[{index}]"), each.part)
        for index, (each, label) in enumerate(zip(found, labels, strict=True))
    ]


def _from_document(data: Mapping[str, Any], width: int, height: int) -> list[QueryPoint]:
    from .checking import check_document
    from .scene_json import query_points_of

    document = check_document(dict(data))
    scale = (width / document["width"], height / document["height"], 1.0)
    return [point.rescaled(scale) for point in query_points_of(document)]


def _query_point(item: Any, name: str) -> QueryPoint:
    x, y = _coordinates(item, name)
    label: Any = None
    if isinstance(item, Mapping):
        label = item.get("label")
    elif len(item) > 2:
        label = item[2]
    return QueryPoint(x, y, _label(label, f"{name} label"), _part(item, name))


def _label(label: Any, name: str) -> bool:
    if label is None or label == "":
        return True
    known = isinstance(label, str | int | float | np.generic)
    word = str(label).strip().lower() if known else ""
    require(name, label, word in _LABELS, "1 (on the object) or 0 (beside it)")
    return _LABELS[word]


def _part(item: Any, name: str) -> int:
    given: Any = item.get("part", 0) if isinstance(item, Mapping) else item[3] if len(item) == 4 else 0
    try:
        part = float(given if given not in (None, "") else 0)
    except (TypeError, ValueError, OverflowError):
        part = -1.0
    require(f"{name} part", given, part in range(MAX_PARTS), f"a whole number from 0 to {MAX_PARTS - 1}")
    return int(part)


def _coordinates(item: Any, name: str) -> tuple[float, float]:
    if isinstance(item, Mapping) and {"x", "y"} <= item.keys():
        values = (item["x"], item["y"])
    elif isinstance(item, Sequence | np.ndarray) and not isinstance(item, str) and len(item) in (2, 3, 4):
        values = (item[0], item[1])
    else:
        raise InvalidInputError(f"{name} must be {POINT_FORMS}. Got: {shown(item)}")
    if any(isinstance(value, bool | np.bool_) for value in values):
        raise InvalidInputError(f"{name} must hold two numbers. Got: {shown(item)}")
    try:
        x, y = (float(value) for value in values)
    except OverflowError:
        x = y = np.inf
    except (TypeError, ValueError):
        raise InvalidInputError(f"{name} must hold two numbers. Got: {shown(item)}") from None
    require(name, item, bool(np.isfinite((x, y)).all()), "finite pixel coordinates")
    return x, y
