"""Masks that are given twice and plates of another picture are told of; repainted plates and neighbours are not."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.doubtful_inputs import doubts_about_plate, repeated_masks
from physanimator.rendering.parts import parts_of_picture

HEIGHT, WIDTH = 120, 160


def picture() -> np.ndarray:
    noise = np.random.default_rng(0).normal(size=(HEIGHT, WIDTH, 3)).astype(np.float32)
    return np.clip(130 + 400 * cv2.GaussianBlur(noise, (0, 0), 4), 0, 255).astype(np.uint8)


def mask(left: int = 40) -> np.ndarray:
    plane = np.zeros((HEIGHT, WIDTH), np.float32)
    plane[20:100, left : left + 50] = 1
    return plane


def test_a_mask_given_twice_is_told_and_neighbours_are_not() -> None:
    (sentence,) = repeated_masks([mask(), mask(100), cv2.GaussianBlur(mask(), (0, 0), 1)])
    assert sentence.startswith("bodies[2]: the mask covers what that of part 1 does")
    assert repeated_masks([mask(), mask(60), mask(100)]) == []
    assert repeated_masks([mask()]) == []


@pytest.mark.parametrize("alpha", [False, True])
@pytest.mark.parametrize("exact", [True, False])
def test_a_plate_of_another_picture_is_told(alpha: bool, exact: bool) -> None:
    image, other = picture(), picture()[::-1, ::-1].copy()
    if alpha:
        image, other = (np.dstack([each, np.full((HEIGHT, WIDTH), 255, np.uint8)]) for each in (image, other))
    if exact:
        image, other = (each.astype(np.float32) / 255 for each in (image, other))
    (sentence,) = doubts_about_plate(image, other, [mask()])
    assert sentence.startswith("the plate differs from the picture on ")


@pytest.mark.parametrize("how", ["same", "painted behind", "jpeg", "warmer", "none", "all moves"])
def test_plates_as_they_are_made_say_nothing(how: str) -> None:
    image, moving = picture(), mask()
    plate: np.ndarray | None = image.copy()
    if how == "painted behind":
        plate[moving > 0] = 255 - plate[moving > 0]
    elif how == "jpeg":
        plate = cv2.imdecode(cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, 20])[1], cv2.IMREAD_COLOR)
    elif how == "warmer":
        plate = np.clip(image.astype(int) + (25, 5, -20), 0, 255).astype(np.uint8)
    elif how == "none":
        plate = None
    elif how == "all moves":
        moving = np.ones_like(moving)
    assert doubts_about_plate(image, plate, [moving]) == []


def test_the_parts_tell_of_it() -> None:
    options = {"spacing": 12.0, "in_front": None, "pixel_art": False}
    parts = parts_of_picture(picture(), [mask(), mask()], ["a", "b"], plate=picture()[::-1].copy(), **options)
    assert [note.split(":")[0].split(" differs")[0] for note in parts.notes[-2:]] == ["bodies[1]", "the plate"]
