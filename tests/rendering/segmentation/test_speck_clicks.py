"""Clicks on glints, dots and crossings of lines give the part that they lie on; clicks on small things give these."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.segmentation import segment
from physanimator.rendering.segmentation.cut_judgement import judge_cut

RED, PAPER = (200, 60, 40), (228, 226, 214)


def overlap(mask: np.ndarray, truth: np.ndarray) -> float:
    return float((mask & truth).sum() / (mask | truth).sum())


@pytest.fixture
def part() -> tuple[np.ndarray, np.ndarray]:
    """A red part on paper with its outline, and where it is."""
    picture = np.full((400, 500, 3), PAPER, np.uint8)
    cv2.ellipse(picture, (250, 200), (130, 110), 20, 0, 360, RED, -1, cv2.LINE_AA)
    cv2.ellipse(picture, (250, 200), (130, 110), 20, 0, 360, (60, 20, 20), 2, cv2.LINE_AA)
    truth = np.zeros((400, 500), np.uint8)
    cv2.ellipse(truth, (250, 200), (131, 111), 20, 0, 360, 1, -1)
    return picture, truth > 0


@pytest.mark.parametrize("size", [1, 2, 3, 5])
@pytest.mark.parametrize("colour", [(255, 255, 255), (40, 160, 60), (90, 20, 15)])
def test_a_click_on_a_dot_of_a_part_gives_the_part(
    part: tuple[np.ndarray, np.ndarray], size: int, colour: tuple[int, ...]
) -> None:
    picture, truth = part
    for x in range(170, 340, 17):
        picture[190 : 190 + size, x : x + size] = colour
    point = [(255 + size // 2, 190 + size // 2)]
    mask = segment(picture, point, [1])
    assert overlap(mask, truth) > 0.9
    assert judge_cut(mask, point, [1]) == []


def test_a_click_on_a_thing_of_its_own_gives_that(part: tuple[np.ndarray, np.ndarray]) -> None:
    picture, _ = part
    cv2.circle(picture, (250, 200), 9, (30, 60, 190), -1)
    button = np.zeros(picture.shape[:2], np.uint8)
    cv2.circle(button, (250, 200), 9, 1, -1)
    assert overlap(segment(picture, [(250, 200)], [1]), button > 0) > 0.7


def test_a_dot_on_the_backdrop_does_not_take_the_backdrop(part: tuple[np.ndarray, np.ndarray]) -> None:
    picture, _ = part
    picture[40:43, 60:63] = (20, 20, 20)
    assert segment(picture, [(61, 41)], [1]).sum() < 100


def test_a_point_beside_the_part_close_by_is_kept_out(part: tuple[np.ndarray, np.ndarray]) -> None:
    picture, _ = part
    picture[190:193, 255:258] = (255, 255, 255)
    mask = segment(picture, [(256, 191), (256, 230)], [1, 0])
    assert mask[191, 256]
    assert not mask[230, 256]
