"""Closed-form matting where the answer is known."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.matting import closed_form
from physanimator.rendering.matting.closed_form import solve_alpha

SIZE = 40
ROWS, COLUMNS = np.mgrid[:SIZE, :SIZE]


def test_two_colours_give_the_shares_in_which_they_were_mixed() -> None:
    alpha = np.clip((COLUMNS - 14 + 3 * np.sin(ROWS / 5)) / 9, 0, 1).astype(np.float32)
    image = alpha[..., None] * np.array([0.9, 0.3, 0.2]) + (1 - alpha[..., None]) * np.array([0.2, 0.5, 0.7])
    unknown = (alpha > 0) & (alpha < 1)
    found = solve_alpha(image.astype(np.float32), alpha.round(), unknown, np.zeros_like(alpha), trust=1e-4)
    np.testing.assert_array_equal(found[~unknown], alpha[~unknown])
    assert np.abs(found - alpha).max() < 0.04


def test_without_any_contrast_the_guess_decides() -> None:
    guess = (COLUMNS < 20).astype(np.float32)
    found = solve_alpha(np.full((SIZE, SIZE, 3), 0.5, np.float32), guess, np.ones((SIZE, SIZE), bool), guess, trust=1e3)
    np.testing.assert_allclose(found, guess, atol=0.01)


@pytest.mark.parametrize("shape", [(1, 1), (2, 7), (7, 2)])
def test_pictures_smaller_than_a_window_keep_the_guess(shape: tuple[int, int]) -> None:
    unknown = np.zeros(shape, bool)
    unknown[0, 0] = True
    found = solve_alpha(
        np.zeros((*shape, 3), np.float32),
        np.ones(shape, np.float32),
        unknown,
        np.full(shape, 0.25, np.float32),
        trust=0.1,
    )
    assert found[0, 0] == 0.25
    assert (found.ravel()[1:] == 1).all()


@pytest.mark.parametrize("smooth", [False, True])
def test_wide_unknown_areas_give_what_narrow_ones_do(smooth: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """The solver for many unknowns, asked for few."""
    generator = np.random.default_rng(0)
    image = generator.random((SIZE, SIZE, 3)).astype(np.float32)
    if smooth:
        image = cv2.normalize(cv2.GaussianBlur(image, (0, 0), 4), None, 0, 1, cv2.NORM_MINMAX)
    guess = (generator.random((SIZE, SIZE)) > 0.5).astype(np.float32)
    unknown = np.ones((SIZE, SIZE), bool)
    unknown[:4] = False
    factorised = solve_alpha(image, guess, unknown, guess, trust=0.03)
    monkeypatch.setattr(closed_form, "_FACTORISED", 0)
    np.testing.assert_allclose(solve_alpha(image, guess, unknown, guess, trust=0.03), factorised, atol=0.001)
    assert np.abs(factorised - guess)[unknown].max() > 0.1
