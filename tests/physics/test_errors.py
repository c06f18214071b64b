"""Messages are one short printable line, whatever they repeat."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError, PhysAnimatorError, SceneError, require, shown
from physanimator.physics.json_text import read_json
from physanimator.physics.scene_checking import check_document


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
