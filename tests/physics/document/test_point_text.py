"""Points and paths as people and editors write them."""

from __future__ import annotations

import json

import numpy as np
import pytest
from physanimator.physics.document import parse_points, parse_polyline
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.scene import QueryPoint

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
        ("[[true, false]]", r"points\[0\] must hold two numbers. Got: \[True, False\]"),
        ('[{"x": 1, "y": true}]', r"points\[0\] must hold two numbers"),
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


@pytest.mark.parametrize(
    "points",
    [
        "x,y,label\n10,20,1\n30.5,40,0",
        '"X";"Y";"Label"\r\n10;20;1\r\n30.5;40;0\r\n',
        "id\tx\ty\tlabel\n7\t10\t20\t1\n8\t30.5\t40\t0",
        "10,20,1,\n30.5,40,0,",
        "\ufeff10;20\n30.5;40;0",
        "10,20;30.5,40,0",
        "10,20,+\n30.5,40,bg",
        '{"points": [[10, 20], [30.5, 40]], "labels": [1, 0]}',
        '{"point_coords": [[[10, 20], [30.5, 40]]], "point_labels": [[1, 0]]}',
        {"points": np.array([[10, 20], [30.5, 40]]), "labels": np.array([1, 0])},
        json.dumps({"coordinates_positive": '[{"x": 10, "y": 20}]', "coordinates_negative": '[{"x": 30.5, "y": 40}]'}),
        "[{'x': 10, 'y': 20, 'label': None}, {'x': 30.5, 'y': 40, 'label': False}]",
        "[[10, 20, 1,], [30.5, 40, 0],]",
        '{"x": 10, "y": 20}\n{"x": 30.5, "y": 40, "label": 0}\n',
        "(10, 20), (30.5, 40, 0)",
        '{"normalised": true, "points": [[0.1, 0.4], [0.305, 0.8]], "labels": [1, 0]}',
        '{"normalized": true, "positive": [[0.1, 0.4]], "negative": [[0.305, 0.8]]}',
    ],
)
def test_what_other_editors_and_tables_write(points: object) -> None:
    found = parse_points(points, width=100, height=50)
    assert [(round(p.x, 6), round(p.y, 6), p.positive) for p in found] == [(10, 20, True), (30.5, 40, False)]


def test_a_single_pair_is_one_point() -> None:
    assert parse_points("[10, 20]", width=100, height=50) == EXPECTED[:1]


@pytest.mark.parametrize(
    "points", ['[{"x": 0.55, "y": 0.3}]', "0.5,0.25,1\n1,0.5,0", '{"points": [[0.5, 1]]}', [[0.1, 0.2]]]
)
def test_normalised_points_are_asked_about(points: object) -> None:
    with pytest.raises(
        InvalidInputError, match=r"points must be pixels; if these are normalised, multiply .* Got: all from"
    ):
        parse_points(points, width=100, height=50)


def test_the_corner_of_the_picture_is_no_normalised_point() -> None:
    assert len(parse_points("[[0, 1], [1, 0], [0, 0]]", width=100, height=50)) == 3
    assert len(parse_points("[[0.5, 0.5], [40, 3]]", width=100, height=50)) == 2


def test_a_normalised_path_is_asked_about_but_not_an_offset() -> None:
    with pytest.raises(InvalidInputError, match="stroke must be pixels"):
        parse_polyline("[[0.1, 0.5], [0.9, 0.5]]", name="stroke")
    assert parse_polyline("[[0, 0], [0.9, 0.5]]", offsets=True)[1] == (0.9, 0.5)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ("[" * 200_000, "nested deeper"),
        ('{"a":' * 100_000, "nested deeper"),
        ("(" * 100_000, "nested deeper"),
        ("[[1e999, 2]]", "finite pixel coordinates"),
        (f"[[{'9' * 600}, 2]]", r"finite pixel coordinates. Got: \[999999... \(600 digits\), 2\]"),
        (f"[[{'9' * 6000}, 2]]", "6000 digits"),
        ('{"a\\nb": 1}', r"Got: an object with a\\nb"),
        ('{"points": [[1, 2]], "labels": [1, 0]}', "labels must be one for each of 1 points. Got: 2"),
        ('{"points": 5}', "points must be a list of points"),
        ("1,2\n" * 5000, "at most 1000. Got: 5000 points"),
        ([[1, 2]] * 5000 + ["no point"], "at most 1000. Got: 5001 points"),
        ({"positive": [[1, 2]] * 5000 + ["no point"]}, "positive must be at most 1000. Got: 5001 points"),
        ("[[3, 4, -1]]", "label must be 1"),
        (None, "points must be a list"),
        (b"1,2", "points must be a list"),
    ],
)
def test_hostile_points_are_one_short_line(points: object, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message) as caught:
        parse_points(points, width=100, height=50)
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 500


@pytest.mark.parametrize(
    ("text", "most"),
    [
        ("[" * 1_700_000, "1,600,000 lists"),
        ("[" + ")" * 1_700_000, "1,600,000 brackets"),
        ("[" + "1," * 4_300_000 + "1]", "4,200,000 values"),
        ("[" + "1" * 1_100_000 + "]", "1,000 digits a number"),
        ("1,2\n" * 300_000, "a table of at most 1 MB"),
        ("1" * 1_100_000, "a table of at most 1 MB"),
        # A search for a separator would begin anew at each of these blanks.
        ("1" + "\N{NO-BREAK SPACE}" * 1000 + "2", "lines of at most 1000 characters"),
    ],
)
def test_text_that_holds_too_much_is_refused_before_it_is_read(text: str, most: str) -> None:
    with pytest.raises(InvalidInputError, match=rf"points must (be|hold at most) {most}"):
        parse_points(text, width=100, height=100)
