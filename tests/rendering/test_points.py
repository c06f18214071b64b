"""Points and paths as people and editors write them."""

from __future__ import annotations

import json

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.points import QueryPoint, parse_points, parse_polyline

EXPECTED = [QueryPoint(10.0, 20.0, True), QueryPoint(30.5, 40.0, False)]


@pytest.mark.parametrize(
    "points",
    [
        '[{"x": 10, "y": 20, "label": 1}, {"x": 30.5, "y": 40, "label": 0}]',
        "[[10, 20], [30.5, 40, 0]]",
        "[[10, 20, true], [30.5, 40, false]]",
        '{"positive": [{"x": 10, "y": 20}], "negative": [[30.5, 40]]}',
        "{'positive': [[10, 20]], 'negative': [[30.5, 40]]}",
        "10,20,1\n30.5,40,0\n",
        "# two clicks\n10, 20\n30.5 40 negative  # beside\n",
        [[10, 20, 1], [30.5, 40, 0]],
        [{"x": 10, "y": 20}, {"x": 30.5, "y": 40, "label": "negative"}],
        {"positive": "[[10, 20]]", "negative": [(30.5, 40)]},
    ],
)
def test_every_format_of_query_points(points: object) -> None:
    assert parse_points(points, width=100, height=50) == EXPECTED


def test_an_array_of_points() -> None:
    assert parse_points(np.array([[10, 20, 1], [30.5, 40, 0]]), width=100, height=50) == EXPECTED


def test_a_single_object_is_one_point() -> None:
    assert parse_points('{"x": 1, "y": 2}', width=10, height=10) == [QueryPoint(1.0, 2.0, True)]


def test_no_points_are_no_error_here() -> None:
    assert parse_points("[]", width=10, height=10) == []


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ("[[1, 2], [500, 2]]", r"points\[1\] must lie inside the picture of 100 x 50 px. Got: \(500, 2\)"),
        ("[[1, 2], [3]]", r"points\[1\] must be .*\[x, y\].*Got: \[3\]"),
        ('[{"x": 1}]', r"points\[0\] must be"),
        ('[[1, "left"]]', r"points\[0\] must hold two numbers"),
        ("[[1, 2, 7]]", r"points\[0\] label must be 1 \(on the object\) or 0"),
        ("[[1, 2", "points must be valid JSON"),
        ("", "points must be a list of points.*empty text"),
        ("7", "points must be a list of points"),
        ('{"good": [[1, 2]]}', '"positive" and "negative"'),
        ("[[[1, 2]], [[3, 4]]]", "points must be one path. Got: 2 paths"),
        ("1,2\nhello\n", r"points\[1\] must be"),
        ("[[1, NaN]]", r"points\[0\] must be finite"),
    ],
)
def test_bad_points_name_their_index_and_what_was_expected(points: str, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        parse_points(points, width=100, height=50)


@pytest.mark.parametrize(
    "path",
    [
        '[{"x": 1, "y": 2}, {"x": 3.5, "y": -4}]',
        "[[1, 2], [3.5, -4]]",
        '[[{"x": 1, "y": 2}, {"x": 3.5, "y": -4}]]',
        "[[[1, 2], [3.5, -4]]]",
        json.dumps("[[1, 2], [3.5, -4]]"),
        json.dumps(['[{"x": 1, "y": 2}, {"x": 3.5, "y": -4}]']),
        "1,2\n3.5,-4",
        [(1, 2), (3.5, -4)],
    ],
)
def test_every_format_of_a_path_and_points_outside_the_picture(path: object) -> None:
    assert parse_polyline(path) == [(1.0, 2.0), (3.5, -4.0)]


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("[]", "stroke must be at least one point"),
        ("[[[1, 2]], [[3, 4]]]", "stroke must be one path. Got: 2 paths"),
        ('{"x": 1, "y": 2}', "stroke must be a list of points"),
        ("[[1, 2], 3]", r"stroke\[1\] must be"),
    ],
)
def test_bad_paths(path: str, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        parse_polyline(path, name="stroke")


def document(**changes: object) -> dict[str, object]:
    points = [{"x": 5, "y": 10}, {"x": 15.25, "y": 20, "positive": False}]
    return {"version": 2, "width": 50, "height": 25, "query_points": points} | changes


@pytest.mark.parametrize("written", [document(), json.dumps(document()), json.dumps(json.dumps(document()))])
def test_a_scene_document_gives_its_query_points_scaled_to_the_picture(written: object) -> None:
    assert parse_points(written, width=100, height=50) == EXPECTED
    assert parse_points(document(query_points=[]), width=100, height=50) == []


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"query_points": [{"x": 51, "y": 3}]}, r"points\[0\] must lie inside the picture of 100 x 50 px"),
        ({"query_points": [{"x": 5}]}, r"query_points\[0\].y: is missing"),
        ({"width": 0}, "width: must be at least 1 px"),
        ({"version": 3}, "made by a newer PhysAnimator"),
    ],
)
def test_a_wrong_document_of_query_points(changes: dict[str, object], words: str) -> None:
    with pytest.raises(InvalidInputError, match=words):
        parse_points(document(**changes), width=100, height=50)


def test_a_document_without_a_version_is_no_list_of_points() -> None:
    with pytest.raises(InvalidInputError, match="version: is missing"):
        parse_points({"query_points": []}, width=10, height=10)
