"""Colours of one picture brought to those of another."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.rendering.pictures.colour_matching import colours_of, common_weights, with_colours
from physanimator.rendering.pictures.lab import lab_to_rgb, rgb_to_lab

Image = NDArray[np.float32]


def painting(seed: int = 0, height: int = 120, width: int = 160, *, grey: bool = False) -> Image:
    """Soft patches of colour with dark lines, 0.1 to 0.9."""
    noise = np.random.default_rng(seed).random((height, width, 1 if grey else 3)).astype(np.float32)
    soft = cv2.GaussianBlur(noise, (0, 0), 8).reshape(height, width, -1)
    soft = 0.2 + 0.6 * (soft - soft.min()) / (soft.max() - soft.min())
    picture = np.repeat(soft, 3, axis=2) if grey else soft
    picture[::24] = 0.1
    return picture.astype(np.float32)


def matched(picture: Image, reference: Image, weights: Image | None = None, amount: float = 1.0) -> Image:
    counted = common_weights(picture, reference, weights=weights)
    return with_colours(picture, colours_of(picture, counted), colours_of(reference, counted), amount=amount)


def drifted(picture: Image) -> Image:
    return lab_to_rgb(rgb_to_lab(picture) * np.float32([0.9, 0.85, 0.9]) + np.float32([6, 3, -5]))


def distance(one: Image, other: Image) -> float:
    return float(np.abs(one - other).mean())


def test_lab_is_that_of_the_standard_and_exact_there_and_back() -> None:
    colours = np.float32([[[1, 1, 1], [1, 0, 0], [0, 0, 1], [0.5, 0.5, 0.5], [0, 0, 0]]])
    known = [[100, 0, 0], [53.24, 80.09, 67.2], [32.3, 79.2, -107.86], [53.39, 0, 0], [0, 0, 0]]
    np.testing.assert_allclose(rgb_to_lab(colours)[0], known, atol=0.02)
    levels = np.random.default_rng(1).random((200, 200, 3)).astype(np.float32)
    np.testing.assert_allclose(lab_to_rgb(rgb_to_lab(levels)), levels, atol=3e-5)


@pytest.mark.parametrize("size", [(120, 160), (1000, 700), (9, 12)])
def test_a_drift_goes(size: tuple[int, int]) -> None:
    truth = painting(0, *size)
    before, after = distance(drifted(truth), truth), distance(matched(drifted(truth), truth), truth)
    assert before > 0.02
    assert after < before / 5


def test_most_of_a_drift_that_is_not_linear_in_lab_goes() -> None:
    truth = painting()
    wrong = np.clip(truth * np.float32([0.85, 0.95, 1.05]) + np.float32([0.02, 0.04, 0]), 0, 1).astype(np.float32)
    assert distance(matched(wrong, truth), truth) < distance(wrong, truth) / 2


def test_half_of_it_goes_with_half_the_amount() -> None:
    truth = painting()
    wrong = drifted(truth)
    lab = [rgb_to_lab(each).mean(axis=(0, 1)) for each in (wrong, matched(wrong, truth, amount=0.5), truth)]
    np.testing.assert_allclose(lab[1], (lab[0] + lab[2]) / 2, atol=0.15)
    assert matched(wrong, truth, amount=0) is wrong


@pytest.mark.parametrize("grey", [False, True])
def test_what_is_right_stays_to_the_bit(grey: bool) -> None:
    truth = painting(grey=grey)
    np.testing.assert_array_equal(matched(truth.copy(), truth), truth)


def test_colours_that_are_spread_alike_stay_even_if_all_is_elsewhere() -> None:
    truth = painting(height=128, width=128)
    mirrored = np.ascontiguousarray(truth[:, ::-1])
    np.testing.assert_allclose(matched(mirrored, truth), mirrored, atol=1e-4)


def test_holes_do_not_count() -> None:
    truth = painting()
    wrong, known = drifted(truth), np.ones(truth.shape[:2], np.float32)
    reference = truth.copy()
    reference[30:90, 40:120], known[30:90, 40:120] = (1, 0, 1), 0
    free = matched(wrong, reference, known)
    assert distance(free, truth) < distance(wrong, truth) / 5
    assert distance(matched(wrong, reference), truth) > 2 * distance(free, truth), "they would, if they counted"


@pytest.mark.parametrize("flat", [(0.5, 0.5, 0.5), (1, 1, 1), (0, 0, 0), (0.9, 0.2, 0.1)])
def test_flat_pictures_get_the_colour_and_nothing_else(flat: tuple[float, ...]) -> None:
    truth = np.full((64, 80, 3), flat, np.float32)
    wrong = np.clip(truth + np.float32([0.04, -0.03, 0.02]), 0, 1)
    got = matched(wrong, truth)
    assert np.isfinite(got).all()
    np.testing.assert_allclose(got, truth, atol=2e-3)


def test_a_grey_picture_loses_a_tint_and_gets_none() -> None:
    truth = painting(grey=True)
    got = matched(drifted(truth), truth)
    assert np.ptp(got, axis=2).mean() < np.ptp(drifted(truth), axis=2).mean() / 5
    coloured = matched(truth, painting(3))
    assert np.isfinite(coloured).all(), "nothing in it says which pixel should have which colour"


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_pixels_that_are_no_numbers_harm_no_others(bad: float) -> None:
    truth = painting()
    wrong = drifted(truth)
    wrong[10:20, 10:20, 1] = bad
    got = matched(wrong, truth)
    np.testing.assert_array_equal(got[10:20, 10:20], wrong[10:20, 10:20])
    rest = np.isfinite(got).all(axis=2)
    assert rest.sum() == rest.size - 100
    assert distance(got[rest], truth[rest]) < distance(drifted(truth), truth) / 5


def test_nothing_known_changes_nothing_and_a_few_pixels_change_little() -> None:
    truth = painting()
    wrong, known = drifted(truth), np.zeros(truth.shape[:2], np.float32)
    assert matched(wrong, truth, known) is wrong
    assert matched(np.full_like(wrong, np.nan), truth) is not None
    known[60, 80] = 1
    strange = truth.copy()
    strange[60, 80] = (1, 0, 0)
    assert np.abs(matched(wrong, strange, known) - wrong).max() < 0.12, "one pixel tells little"


def test_lines_are_not_sharpened_where_a_drawing_is_soft() -> None:
    """Fine lines that a model draws softly are no drift of colours."""
    truth = np.ones((128 * 4, 128 * 4, 3), np.float32)
    truth[::4] = truth[:, ::4] = 0
    soft = cv2.blur(truth, (4, 4))
    assert np.abs(matched(soft, truth) - soft).mean() < 0.02
