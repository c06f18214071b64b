"""What is said about cuts that cannot be meant."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.scene import QueryPoint
from physanimator.rendering.segmentation import Prompt, judge_cuts, judge_points, prompts_of, segment_parts
from physanimator.rendering.segmentation.cut_judgement import judge_cut

HEIGHT, WIDTH = 300, 400


def mask_of(*boxes: tuple[int, int, int, int]) -> np.ndarray:
    mask = np.zeros((HEIGHT, WIDTH), bool)
    for x0, y0, x1, y1 in boxes:
        mask[y0:y1, x0:x1] = True
    return mask


def test_a_cut_as_it_should_be_says_nothing() -> None:
    mask = mask_of((50, 50, 150, 200), (200, 50, 220, 70))
    assert judge_cut(mask, [(60, 60), (210, 60), (300, 200)], [1, 1, 0]) == []
    assert judge_cut(mask_of((0, 0, 400, 290)), [(60, 60), (10, 200)], [1, 1]) == []


def test_specks_at_the_points_are_named_with_their_places() -> None:
    mask = mask_of((50, 50, 150, 200), (300, 100, 302, 102), (320, 30, 321, 31))
    (sentence,) = judge_cut(mask, [(60, 60), (301, 101), (320, 30)], [1, 1, 1])
    assert sentence.startswith(
        "2 of 3 points on the part cut out hardly more than themselves, at (301, 101), (320, 30)"
    )
    (single,) = judge_cut(mask, [(320, 30)], [1])
    assert single.startswith("The point on the part cut out hardly more than itself, at (320, 30)")


def test_a_point_that_is_not_in_the_cut_is_named() -> None:
    (sentence,) = judge_cut(mask_of((50, 50, 150, 200)), [(60, 60), (300, 10)], [1, 1])
    assert "1 of 2 points on the part" in sentence
    assert "(300, 10)" in sentence


def test_most_of_the_picture_from_one_point() -> None:
    (sentence,) = judge_cut(mask_of((0, 0, 400, 200)), [(60, 60)], [1])
    assert sentence.startswith("The cut is 67 % of the picture from one point")
    assert judge_cut(mask_of((0, 0, 400, 200)), [(60, 60)], [1], box=(0, 0, 400, 200)) == []


@pytest.mark.parametrize("spared", [False, True])
def test_a_point_beside_the_part_that_is_inside_it(spared: bool) -> None:
    mask = mask_of((50, 50, 150, 200))
    mask[100, 100] = not spared
    (sentence,) = judge_cut(mask, [(60, 60), (100, 100)], [1, 0])
    assert sentence.startswith("The cut goes around 1 of 1 points beside the part, at (100, 100)")


def test_nothing() -> None:
    (sentence,) = judge_cut(mask_of(), [], [], box=(0, 0, 10, 10))
    assert sentence.startswith("Nothing was cut")


def test_parts_are_told_apart_and_the_way_out_comes_last_and_once() -> None:
    masks = [mask_of((50, 50, 150, 200)), mask_of((5, 5, 6, 6)), mask_of()]
    prompts = [Prompt([(60, 60)], [1]), Prompt([(5, 5)], [1]), Prompt(box=(1, 1, 9, 9))]
    told = judge_cuts(masks, prompts, instead="Use a network.")
    assert [each.split(":")[0] for each in told] == ["Part 2", "Part 3", "Use a network."]
    assert judge_cuts(masks[:1], prompts[:1], instead="Use a network.") == []


def test_parts_have_the_numbers_that_people_see() -> None:
    points = [QueryPoint(60, 60), QueryPoint(5, 5, part=2)]
    told = judge_cuts([mask_of((50, 50, 150, 200)), mask_of((5, 5, 6, 6))], prompts_of(points))
    assert [each.split(":")[0] for each in told] == ["Part 3"]
    picture = np.full((40, 40, 3), 200, np.uint8)
    with pytest.raises(InvalidInputError, match=r"^Part 3: points must be with one on the part"):
        segment_parts(picture, prompts_of([QueryPoint(6, 6), QueryPoint(5, 5, positive=False, part=2)]))


def test_points_are_judged_as_they_are_read() -> None:
    assert judge_points([mask_of((50, 50, 150, 200))], ["[[60, 60, 1], [300, 20, 0]]"]) == []
    (sentence,) = judge_points([mask_of((0, 0, 400, 290))], ["60,60"])
    assert "97 %" in sentence


def test_what_is_too_small_for_a_mesh_is_always_said() -> None:
    mask = np.zeros((32, 32), bool)
    mask[4, 5:8] = True
    (sentence,) = judge_cut(mask, [(6, 4)], [1])
    assert sentence.startswith("The cut is too small to move, 3 px: put more points")
    mask[5, 5] = True
    assert judge_cut(mask, [(6, 4)], [1]) == []


def test_a_part_of_a_few_pixels_in_a_tiny_picture_is_no_speck() -> None:
    mask = np.zeros((32, 32), bool)
    mask[4:7, 5:8] = True
    assert judge_cut(mask, [(6, 5)], [1]) == []
