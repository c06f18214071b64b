"""Alpha behind an outline that was found beside a mask."""

from __future__ import annotations

import numpy as np
from physanimator.rendering.matting.line_fill import filled_behind_lines

Y, X = np.mgrid[:60, :60]
AWAY = np.hypot(X - 30, Y - 30)
MASK = (AWAY < 18).astype(np.float32)
SUPPORT = AWAY < 23


def outlined(between: float) -> np.ndarray:
    """Alpha of a disc, of what is between it and its line, and of the line."""
    return np.where(MASK > 0, 1, np.where(AWAY < 20, between, np.where(SUPPORT, 0.9, 0))).astype(np.float32)


def test_what_a_line_divides_from_outside_shows_no_more_than_the_line() -> None:
    filled = filled_behind_lines(outlined(0.3), MASK, SUPPORT)
    assert filled[(AWAY >= 18) & (AWAY < 20)].min() > 0.89
    assert (filled[AWAY >= 20] == outlined(0.3)[AWAY >= 20]).all()


def test_what_is_open_to_the_outside_stays() -> None:
    alpha = outlined(0.3)
    alpha[(np.abs(Y - 30) < 2) & (X > 30) & (AWAY >= 18)] = 0.1
    filled = filled_behind_lines(alpha, MASK, SUPPORT)
    assert filled[30, 50] == np.float32(0.1)


def test_a_wide_gap_behind_a_line_may_show_the_background() -> None:
    gap = np.hypot(X - 30, Y - 12) < 3
    mask = np.where(np.hypot(X - 30, Y - 12) < 4, 0, MASK).astype(np.float32)
    alpha = np.where(gap, 0, outlined(0.9)).astype(np.float32)
    assert filled_behind_lines(alpha, mask, SUPPORT)[12, 30] == 0


def test_without_an_outline_nothing_changes() -> None:
    alpha = np.where(MASK > 0, 0.6, 0).astype(np.float32)
    assert filled_behind_lines(alpha, MASK, MASK > 0) is alpha
