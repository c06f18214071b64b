"""Typed values that are refused before any work."""

from __future__ import annotations

import pytest
from physanimator.nodes.host import boxes_of, chosen, default_of, keys_of, refusal, times_of, whole_numbers_of
from physanimator.physics.errors import InvalidInputError, require


@pytest.mark.parametrize("text", ["[0, 0.5, 2]", "0, 0.5, 2", " [0,0.5,2] "])
def test_times_in_every_form(text: str) -> None:
    assert times_of(text) == (0.0, 0.5, 2.0)


@pytest.mark.parametrize("text", ["", "  ", "[]"])
def test_no_times(text: str) -> None:
    assert times_of(text) == ()


@pytest.mark.parametrize("text", ["1" * 400, "soon", "[0, [1]]", "0 1", '["a"]', "[0, null]"])
def test_bad_times_are_refused_by_name(text: str) -> None:
    with pytest.raises(InvalidInputError, match=r"^motion times must be a list of seconds such as \[0, 0\.5, 2\]"):
        times_of(text, name="motion times")


def test_frame_numbers() -> None:
    assert whole_numbers_of("0, 12,15", name="keyframes_at") == (0, 12, 15)
    assert whole_numbers_of(" ", name="keyframes_at") == ()
    for text in ("0, 1.5", "soon", "[" * 100_000):
        with pytest.raises(InvalidInputError, match=r"^keyframes_at must be"):
            whole_numbers_of(text, name="keyframes_at")


def wide(text: str) -> str:
    """As an East Asian keyboard writes it."""
    return "".join(chr(ord(each) + 0xFEE0) if each != " " else "\u3000" for each in text)


@pytest.mark.parametrize("text", [wide("0, 40,-1"), wide("[0,40,-1]"), "0\u300140\u3001-1", "0, 40, \u22121"])
def test_numbers_as_east_asian_keyboards_write_them(text: str) -> None:
    assert whole_numbers_of(text, name="keyframes") == (0, 40, -1)


def test_boxes_and_keys_as_east_asian_keyboards_write_them() -> None:
    assert boxes_of(wide("[0,1,2,3]"), name="box") == ((0, 1, 2, 3),)
    assert keys_of(wide("[[0, 1], [1, 0.5]]"), name="speed_keys") == ((0.0, 1.0), (1.0, 0.5))


def test_keys_along_a_path() -> None:
    assert keys_of(" [[0, 1], [0.5, 2.5]] ", name="speed_keys") == ((0.0, 1.0), (0.5, 2.5))
    assert keys_of(" ", name="speed_keys") == keys_of("[]", name="speed_keys") == ()


@pytest.mark.parametrize(
    "text", ["late", "3", "[0, 1]", "[[0, 1, 2]]", '[[0, "a"]]', "[[0, null]]", "{}x", "[[0, 1]", "[" * 100_000]
)
def test_bad_keys_are_refused_by_name(text: str) -> None:
    with pytest.raises(InvalidInputError, match=r"^speed_keys must be a list of pairs \[part of the path from 0 to 1"):
        keys_of(text, name="speed_keys")


@pytest.mark.parametrize("text", ["[1, 2, 3]", "[3, 3, 1, 1]", "{}", "[" * 100_000])
def test_bad_boxes_are_refused_by_name(text: str) -> None:
    with pytest.raises(InvalidInputError, match=r"^box must be \[x0, y0, x1, y1\]"):
        boxes_of(text, name="box")


def test_the_choice_and_what_it_brings() -> None:
    assert chosen({"region": "circle", "radius": 3.0}, "region", ("circle", "mask")) == ("circle", {"radius": 3.0})


@pytest.mark.parametrize("choice", [None, {}, {"region": "blob"}, {"region": None}])
def test_an_unknown_choice_is_refused(choice: dict | None) -> None:
    with pytest.raises(InvalidInputError, match=r"^region must be one of circle, mask\. Got:"):
        chosen(choice, "region", ("circle", "mask"))


def test_a_refusal_is_the_sentence_of_the_first_failing_check() -> None:
    def fail(name: str) -> None:
        require(name, 1, False, "another")

    assert refusal(lambda: 1, lambda: fail("radius"), lambda: fail("speed")) == "radius must be another. Got: 1"
    assert refusal(lambda: None) is True


def test_a_mistake_of_ours_is_not_passed_off_as_the_user_s() -> None:
    with pytest.raises(ZeroDivisionError):
        refusal(lambda: 1 / 0)


def test_defaults_are_read_from_the_function() -> None:
    def draw(image: object, *, width: float = 2.5) -> None: ...

    assert default_of(draw, "width") == 2.5
