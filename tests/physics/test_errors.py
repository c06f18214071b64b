"""Messages are one short printable line, whatever they repeat."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from physanimator.physics.document import check_document, read_json
from physanimator.physics.errors import InvalidInputError, PhysAnimatorError, SceneError, counted, require, shown


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (3.5, "3.5"),
        ("girl\n\x1b[31m.png", "girl\\n\\x1b[31m.png"),
        ("héllo 髪 👩‍🎨", "héllo 髪 👩‍🎨"),
        ("\u202egnp.lrig", "\\u202egnp.lrig"),
        ("\udc80", "\\udc80"),
        (10**628, "100000... (629 digits)"),
        (list(range(1000)), "list of 1000"),
        (b"x" * 1000, "bytes of 1000"),
        ([1, 2], "[1, 2]"),
    ],
)
def test_values_are_shown_short_and_printable(value: object, expected: str) -> None:
    assert shown(value) == expected
    with pytest.raises(InvalidInputError) as caught:
        require("radius", value, False, "1 px")
    assert str(caught.value) == f"radius must be 1 px. Got: {expected}"


@pytest.mark.parametrize(
    ("number", "thing", "expected"), [(1, "point", "1 point"), (0, "point", "0 points"), (2, "entry", "2 entries")]
)
def test_one_thing_is_counted_in_the_singular(number: int, thing: str, expected: str) -> None:
    assert counted(number, thing) == expected


def test_a_number_that_python_does_not_write() -> None:
    assert shown(10**9000) == "a number of thousands of digits"


def test_a_nested_value_and_a_long_one_are_cut() -> None:
    deep: list[Any] = []
    for _ in range(100_000):
        deep = [deep]
    assert len(shown(deep)) < 150
    assert len(shown("x" * 10_000)) < 150
    assert shown(np.zeros((3, 3))).isprintable()


def test_no_error_prints_what_it_should_not() -> None:
    wild = "a\nb\x00" + "9" * 700 + "z" * 5000
    for error in (PhysAnimatorError(wild), InvalidInputError(wild), SceneError(wild, wild)):
        assert str(error).isprintable()
        assert len(str(error)) < 1300
        assert "(700 digits)" in str(error)


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ({"a\nb": 1}, r"\"a\\nb\": is not known here"),
        ({"version": 10**628}, r"\(629 digits\)"),
        ({"width": -(10**628)}, r"\(629 digits\)"),
        ({"strokes": [{"kind": "wi\tnd"}]}, r"wi\\tnd"),
        ({"x" * 100_000: 1}, r"\.\.\."),
    ],
)
def test_scene_documents_with_wild_keys_and_numbers(document: dict[str, Any], message: str) -> None:
    whole = {"version": 2, "width": 9, "height": 9} | document
    with pytest.raises(SceneError, match=message) as caught:
        check_document(read_json(json.dumps(whole)))
    assert str(caught.value).isprintable()
    assert caught.value.path.isprintable()
    assert len(str(caught.value)) < 1300


def test_a_repeated_wild_key() -> None:
    with pytest.raises(SceneError, match=r"a\\nb: stands twice") as caught:
        read_json('{"a\\nb": 1, "a\\nb": 2}')
    assert str(caught.value).isprintable()


class Unspoken(list[Any]):
    """A list that nobody writes out."""

    def __repr__(self) -> str:
        raise AssertionError("a list of millions would have been written out")


class Unread(Unspoken):
    """A list that nobody looks into either."""

    def __iter__(self) -> Iterator[Any]:
        raise AssertionError("a list that is too long would have been read")


@pytest.mark.parametrize(
    ("document", "message"),
    [
        ({"gravity": Unspoken([1])}, "gravity: must be a list of 2 numbers. Got: a list of 1"),
        ({"gravity": Unread([1.0] * 400)}, "gravity: must be a list of 2 numbers. Got: a list of 400"),
        ({"frame_rate": Unread([1])}, "frame_rate: must be a number. Got: a list of 1"),
        ({"wind": {"strength": Unread()}}, r"wind.strength: must be a number. Got: a list of 0"),
        ({"strokes": [{"kind": Unread([1])}]}, r"strokes\[0\].kind: must be one of .* Got: a list of 1"),
        ({"strokes": Unread([{}] * 2000)}, "strokes: must have at most 1000 entries. Got: a list of 2000"),
        ({"strokes": [{"path": Unread([[0, 0]] * 20_000)}]}, r"strokes\[0\].path: must have at most 10000 entries"),
        ({"paint": [{"region": {"type": Unread()}}]}, r"paint\[0\].region.type: must be one of"),
        ({"bodies": {"a": Unspoken([1])}}, "bodies: must be a list. Got: an object"),
        ({"unknown": Unread([1])}, "unknown: is not known here"),
    ],
)
def test_lists_are_counted_and_not_written_out(document: dict[str, Any], message: str) -> None:
    with pytest.raises(SceneError, match=message):
        check_document({"version": 2, "width": 9, "height": 9} | document)
