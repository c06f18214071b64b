"""Several parts in one call."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.document import parse_points
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.segmentation import prompts_of, segment_parts

HEIGHT, WIDTH = 120, 200
ROWS, COLUMNS = np.mgrid[:HEIGHT, :WIDTH] + 0.5


def square(x: int, y: int, side: int) -> np.ndarray:
    return (abs(COLUMNS - x) < side / 2) & (abs(ROWS - y) < side / 2)


def page() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    picture = np.full((HEIGHT, WIDTH, 3), (120, 160, 220), np.uint8)
    left, right = square(70, 60, 60), square(130, 60, 60)
    picture[left], picture[right] = (220, 80, 70), (226, 96, 60)
    return picture, left, right


def overlap(a: np.ndarray, b: np.ndarray) -> float:
    return float((a & b).sum() / (a | b).sum())


def test_each_part_gets_a_mask_and_the_others_points_are_beside_it() -> None:
    picture, left, right = page()
    points = parse_points("[[70, 60, 1], [130, 60, 1, 3]]", width=WIDTH, height=HEIGHT)
    masks = segment_parts(picture, prompts_of(points))
    assert len(masks) == 2
    assert overlap(masks[0], left) > 0.95
    assert overlap(masks[1], right) > 0.95


def test_boxes_belong_to_the_parts_in_their_order() -> None:
    picture, left, right = page()
    masks = segment_parts(picture, prompts_of([], [(38, 28, 100, 92), (100, 28, 162, 92)]))
    assert overlap(masks[0], left) > 0.9
    assert overlap(masks[1], right) > 0.9


def test_masks_are_cleaned() -> None:
    picture, left, _ = page()
    picture[square(60, 60, 14)] = (120, 160, 220)
    prompts = prompts_of(parse_points("[[85, 80, 1], [130, 60, 0]]", width=WIDTH, height=HEIGHT))
    assert not segment_parts(picture, prompts)[0][60, 60]
    assert overlap(segment_parts(picture, prompts, largest_hole=300)[0], left) > 0.95


def test_neither_a_point_nor_a_box_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="at least one point, or a box"):
        prompts_of([])


def test_a_part_with_points_beside_it_only_is_refused() -> None:
    prompts = prompts_of(parse_points("[[70, 60, 1], [10, 10, 0, 1]]", width=WIDTH, height=HEIGHT))
    with pytest.raises(InvalidInputError, match="with one on the part at least"):
        segment_parts(page()[0], prompts)


def test_parts_are_read_from_every_form_of_points() -> None:
    for text in ('[{"x": 1, "y": 2, "part": 4}]', "[[1, 2, 1, 4]]", '{"positive": [{"x": 1, "y": 2, "part": 4}]}'):
        (point,) = parse_points(text, width=10, height=10)
        assert (point.part, point.positive) == (4, True)
    with pytest.raises(InvalidInputError, match=r"points\[0\] part must be a whole number from 0 to 99. Got: 1.5"):
        parse_points("[[1, 2, 1, 1.5]]", width=10, height=10)
