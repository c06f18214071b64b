"""Lines drawn through holes."""

from __future__ import annotations

import numpy as np
from physanimator.rendering.plate import continue_lines

HEIGHT, WIDTH = 160, 200
Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5
HOLE = np.abs(X - 100) < 30


def band(bottom: np.ndarray) -> np.ndarray:
    """A yellow band on grey, from 60 px down to ``bottom``."""
    inside = (Y > 60) & (bottom > Y)
    picture = np.where(inside[..., None], (0.9, 0.8, 0.1), (0.5, 0.55, 0.6)).astype(np.float32)
    return np.where(HOLE[..., None], np.float32(0), picture)


def test_both_borders_of_a_band_run_on() -> None:
    picture, drawn = continue_lines(band(np.full_like(X, 76)), HOLE)
    middle = drawn & (np.abs(X - 100) < 20)
    rows = np.flatnonzero(middle.any(axis=1))
    assert {58, 62, 74, 78} <= set(rows.tolist())
    assert np.abs(picture[57, 90:110] - (0.5, 0.55, 0.6)).max() < 0.05
    assert np.abs(picture[63, 90:110] - (0.9, 0.8, 0.1)).max() < 0.05
    assert not (drawn & ~HOLE).any()


def test_one_border_alone_does_not() -> None:
    _, drawn = continue_lines(band(np.where(X < 100, 76, 140)), HOLE)
    assert not drawn.any()


def test_what_does_not_fit_is_left_alone() -> None:
    picture = np.where((np.where(X < 100, 40, 110) < Y)[..., None], (0.8, 0.7, 0.8), (0.2, 0.2, 0.3)).astype(np.float32)
    _, drawn = continue_lines(np.where(HOLE[..., None], np.float32(0), picture), HOLE)
    assert not drawn.any()


def test_a_plain_picture_has_no_lines() -> None:
    _, drawn = continue_lines(np.full((HEIGHT, WIDTH, 3), 0.4, np.float32), HOLE)
    assert not drawn.any()
