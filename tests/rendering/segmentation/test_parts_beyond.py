"""What lies across a strap from a cut is named, and other things of the same colour are not."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.segmentation import Prompt, judge_cuts, judge_points, segment
from physanimator.rendering.segmentation.parts_beyond import parts_beyond

HEIGHT, WIDTH = 240, 320


def bag(*, strap: int, angle: float = 1.2, line: int = 2, noise: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A round bag crossed by a strap, and where the bag shows on both sides of it."""
    picture = np.full((HEIGHT, WIDTH, 3), (225, 215, 190), np.uint8)
    part = cv2.ellipse(np.zeros((HEIGHT, WIDTH), np.uint8), (160, 120), (70, 55), 0, 0, 360, 1, -1)
    picture[part > 0] = (150, 60, 90)
    along = 400 * np.array([np.cos(angle), np.sin(angle)])
    ends = [np.rint((160, 120) + sign * along).astype(int).tolist() for sign in (-1, 1)]
    band = cv2.line(np.zeros((HEIGHT, WIDTH), np.uint8), *ends, 1, strap)
    picture[band > 0] = (70, 110, 80)
    if line:
        for shape in (part, band):
            outline, _ = cv2.findContours(shape, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
            cv2.polylines(picture, outline, True, (40, 25, 30), line, cv2.LINE_AA)
    if noise:
        shaken = picture + np.random.default_rng(0).normal(0, noise, picture.shape)
        picture = np.clip(shaken, 0, 255).astype(np.uint8)
    return picture, (part > 0) & (cv2.dilate(band, np.ones((3, 3), np.uint8)) == 0)


@pytest.mark.parametrize("strap", [6, 12, 20])
@pytest.mark.parametrize("line", [0, 2])
@pytest.mark.parametrize("noise", [0.0, 6.0])
@pytest.mark.parametrize("angle", [0.3, 1.2])
def test_the_other_side_of_a_strap_is_named(strap: int, line: int, noise: float, angle: float) -> None:
    picture, part = bag(strap=strap, line=line, noise=noise, angle=angle)
    points = [(120, 135) if angle > 1 else (155, 150)]
    mask = segment(picture, points, [1])
    assert 0.2 < (mask & part).sum() / part.sum() < 0.8
    (sentence,) = judge_cuts([mask], [Prompt(points, [1])], image=picture)
    found = parts_beyond(picture, mask)[0]
    assert f"({found.x}, {found.y})" in sentence
    assert part[found.y, found.x]
    assert not mask[found.y, found.x]
    assert judge_cuts([mask], [Prompt(points, [1])]) == []


def test_both_sides_clicked_say_nothing() -> None:
    picture, part = bag(strap=12)
    points = [(120, 135), (205, 105)]
    mask = segment(picture, points, [1, 1])
    assert (mask & part).sum() > 0.9 * part.sum()
    assert judge_cuts([mask], [Prompt(points, [1, 1])], image=picture) == []


def test_what_was_said_to_lie_beside_or_is_another_part_is_none() -> None:
    picture, _ = bag(strap=12)
    left, right = (segment(picture, [point], [1]) for point in ((120, 135), (205, 105)))
    prompt = Prompt([(120, 135)], [1])
    assert len(judge_cuts([left], [prompt], image=picture)) == 1
    assert judge_cuts([left], [Prompt([(120, 135), (205, 105)], [1, 0])], image=picture) == []
    assert judge_cuts([left, right], [prompt, Prompt([(205, 105)], [1])], image=picture) == []


@pytest.mark.parametrize("away", [60, 100])
def test_the_same_colour_far_off_is_none(away: int) -> None:
    picture = np.full((HEIGHT, WIDTH, 3), (225, 215, 190), np.uint8)
    picture[80:160, 40:100] = picture[80:160, 100 + away : 160 + away] = (150, 60, 90)
    mask = np.zeros((HEIGHT, WIDTH), bool)
    mask[80:160, 40:100] = True
    assert parts_beyond(picture, mask) == []


@pytest.mark.parametrize("empty", [True, False])
def test_nothing_and_everything_say_nothing(empty: bool) -> None:
    picture = np.full((HEIGHT, WIDTH, 3), 200, np.uint8)
    assert parts_beyond(picture, np.full((HEIGHT, WIDTH), not empty)) == []


def test_points_as_text_are_judged_with_the_picture() -> None:
    picture, _ = bag(strap=12)
    mask = segment(picture, [(120, 135)], [1])
    (sentence,) = judge_points([mask], ["120,135"], image=picture)
    assert sentence.startswith("The cut ends at something narrow")
