"""Specks, holes and ragged edges of masks."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.segmentation.mask_cleanup import clean_mask

ROWS, COLUMNS = np.mgrid[:80, :100]


def disc(x: float, y: float, radius: float) -> np.ndarray:
    return np.hypot(COLUMNS + 0.5 - x, ROWS + 0.5 - y) <= radius


def test_specks_below_the_limit_go_and_larger_ones_stay() -> None:
    part, speck, piece = disc(30, 40, 20), disc(70, 20, 2), disc(80, 60, 5)
    cleaned = clean_mask(part | speck | piece, smallest_speck=40)
    np.testing.assert_array_equal(cleaned, part | piece)


def test_the_largest_piece_always_stays() -> None:
    part = disc(30, 40, 4)
    np.testing.assert_array_equal(clean_mask(part | disc(70, 20, 2), smallest_speck=10_000), part)


def test_holes_up_to_the_limit_are_filled_but_not_the_outside() -> None:
    part, hole, window = disc(40, 40, 30), disc(30, 40, 2), disc(52, 40, 6)
    cleaned = clean_mask(part & ~hole & ~window, largest_hole=int(hole.sum()))
    np.testing.assert_array_equal(cleaned, part & ~window)


def test_smoothing_evens_spikes_and_moves_no_straight_edge() -> None:
    half = COLUMNS < 40
    spiky = (half | ((ROWS == 30) & (COLUMNS < 50))) & ~((ROWS == 50) & (COLUMNS > 30))
    smooth = clean_mask(spiky, smoothing=3.0)
    assert (spiky != half).sum() == 19
    # Next to where the spikes were, the edge is off by a pixel at most.
    assert (smooth != half).sum() <= 6
    assert not (smooth != half)[:, (COLUMNS[0] < 39) | (COLUMNS[0] > 40)].any()


def test_no_cleaning_is_the_default_and_an_empty_mask_stays_empty() -> None:
    noise = np.random.default_rng(0).random((40, 50)) > 0.5
    np.testing.assert_array_equal(clean_mask(noise), noise)
    assert not clean_mask(np.zeros((40, 50), bool), smallest_speck=5, largest_hole=5, smoothing=2.0).any()


def test_a_negative_size_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="largest_hole must be at least 0"):
        clean_mask(disc(10, 10, 5), largest_hole=-1)
