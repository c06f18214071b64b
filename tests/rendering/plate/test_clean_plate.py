"""The clean plate against backgrounds that are known."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.plate import clean_plate

HEIGHT, WIDTH = 120, 160
Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5
MASK = np.hypot(X - 80, (Y - 60) * 1.2) < 24


def gradient() -> np.ndarray:
    return np.stack([60 + X, 200 - Y, 80 + 0.5 * X + 0.5 * Y], axis=-1).round().astype(np.uint8)


def bricks() -> np.ndarray:
    joints = (Y % 12 < 2) | ((X + 9 * (Y // 12 % 2)) % 18 < 2)
    picture = np.where(joints[..., None], (190, 180, 170), (150, 80, 60)) + gradient() * 0.1
    return picture.round().astype(np.uint8)


def with_disc(picture: np.ndarray, *, outline: int = 0) -> np.ndarray:
    grown = cv2.dilate(MASK.astype(np.uint8), np.ones((2 * outline + 1,) * 2)) > 0
    covered = np.where(grown[..., None], np.uint8(20), picture)
    return np.where(MASK[..., None], np.array([250, 90, 180], np.uint8), covered)


def psnr(a: np.ndarray, b: np.ndarray) -> float:
    return float(10 * np.log10(255**2 / np.mean((a.astype(float) - b) ** 2)))


def test_a_gradient_is_restored() -> None:
    plate = clean_plate(with_disc(gradient()), MASK)
    error = np.abs(plate.astype(int) - gradient())
    assert error.max() <= 14
    assert error[MASK].mean() < 5


def test_pixels_outside_the_mask_are_unchanged() -> None:
    picture = with_disc(bricks(), outline=2)
    plate = clean_plate(picture, MASK)
    assert (plate[~MASK] == picture[~MASK]).all()
    assert (plate[MASK] != picture[MASK]).any(axis=1).all()


def test_texture_runs_on_better_than_with_inpainting() -> None:
    picture = with_disc(bricks())
    ours = psnr(clean_plate(picture, MASK)[MASK], bricks()[MASK])
    theirs = [
        psnr(cv2.inpaint(picture, MASK.astype(np.uint8), radius, method)[MASK], bricks()[MASK])
        for radius in (1, 3, 5, 10)
        for method in (cv2.INPAINT_TELEA, cv2.INPAINT_NS)
    ]
    assert ours > max(theirs) + 1


def test_an_outline_beside_the_mask_does_not_run_into_the_fill() -> None:
    plate = clean_plate(with_disc(gradient(), outline=3), MASK)
    assert np.abs(plate.astype(int) - gradient())[MASK].max() <= 25


def test_the_result_repeats_and_keeps_the_dtype() -> None:
    picture = with_disc(bricks())
    first, again = clean_plate(picture, MASK), clean_plate(picture, MASK)
    assert first.dtype == np.uint8
    assert (first == again).all()
    floats = clean_plate(picture.astype(np.float32) / 255, MASK.astype(np.float32))
    assert floats.dtype == np.float32
    assert np.abs(floats * 255 - first).max() < 0.51


def test_masks_of_other_kinds() -> None:
    picture = with_disc(gradient())
    expected = clean_plate(picture, MASK)
    assert (clean_plate(picture, MASK.astype(np.uint8) * 255) == expected).all()
    untouched = clean_plate(picture, np.zeros((HEIGHT, WIDTH), bool))
    assert (untouched == picture).all()
    assert untouched is not picture


@pytest.mark.parametrize("at", [(60, 80), (0, 0), (119, 159), (0, 80)])
def test_specks_anywhere_are_filled(at: tuple[int, int]) -> None:
    picture = gradient()
    picture[at] = (255, 0, 255)
    mask = np.zeros((HEIGHT, WIDTH), bool)
    mask[at] = True
    assert np.abs(clean_plate(picture, mask).astype(int) - gradient()).max() <= 4


def test_a_mask_that_leaves_little_still_gives_a_plate() -> None:
    mask = np.ones((HEIGHT, WIDTH), bool)
    mask[:, :3] = False
    plate = clean_plate(gradient(), mask)
    assert np.isfinite(plate).all()
    assert plate[mask].min() >= 55


def test_unusable_input_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="leave some of the picture"):
        clean_plate(gradient(), np.ones((HEIGHT, WIDTH), bool))
    with pytest.raises(InvalidInputError, match="proportions"):
        clean_plate(gradient(), np.ones((HEIGHT, HEIGHT), bool))
    with pytest.raises(InvalidInputError, match="image must be an RGB picture"):
        clean_plate(gradient()[..., 0], MASK)
    with pytest.raises(InvalidInputError, match="divide by 255"):
        clean_plate(gradient().astype(np.float64), MASK)


@pytest.mark.parametrize("shape", [(1, 2), (1, 40), (40, 1), (2, 2), (3, 5)])
def test_the_smallest_pictures_get_a_plate(shape: tuple[int, int]) -> None:
    image = np.random.default_rng(0).integers(0, 256, (*shape, 3), dtype=np.uint8)
    mask = np.zeros(shape, dtype=bool)
    mask[0, 0] = True
    plate = clean_plate(image, mask)
    assert (plate[~mask] == image[~mask]).all()


def with_line(picture: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """A picture with an ink line 4 px thick along a middle that is given for every column [px]."""
    share = np.clip(2.5 - np.abs(Y - middle), 0, 1)[..., None]
    return np.rint(picture * (1 - share) + 20 * share).astype(np.uint8)


@pytest.mark.parametrize("bend", [0.0, 0.0015], ids=["straight", "curved"])
def test_a_line_with_both_ends_in_sight_runs_through(bend: float) -> None:
    middle = 50 + 0.1 * X + bend * (X - 80) ** 2
    truth = with_line(gradient(), middle)
    plate = clean_plate(with_disc(truth), MASK)
    on_line, beside = np.abs(Y - middle) < 1, (np.abs(Y - middle) > 4) & (np.abs(Y - middle) < 8)
    assert plate[MASK & on_line].max() < 90
    assert np.abs(plate.astype(int) - truth)[MASK & beside].max() < 40


def test_both_borders_of_an_edge_keep_their_colours() -> None:
    truth = np.where((Y > 55 + 0.15 * X)[..., None], np.uint8((200, 190, 120)), np.uint8((90, 120, 200)))
    plate = clean_plate(with_disc(truth), MASK)
    away = np.abs(Y - 55 - 0.15 * X) > 3
    assert np.abs(plate.astype(int) - truth)[MASK & away].max() < 30


def test_a_line_of_ink_that_ends_at_the_mask_leaves_no_stain() -> None:
    picture = np.full((HEIGHT, WIDTH, 3), 255, np.uint8)
    picture[:60, 78:82] = 0
    plate = clean_plate(with_disc(picture), MASK)
    assert plate[MASK].min() > 245


def test_a_line_that_runs_through_keeps_its_ink_all_the_way() -> None:
    picture = np.full((HEIGHT, WIDTH, 3), 255, np.uint8)
    picture[:, 79:82] = 0
    plate = clean_plate(with_disc(picture), MASK)
    assert plate[MASK[:, 80], 80].max() < 60
    assert plate[MASK & (abs(X - 80.5) > 6)].min() > 235
