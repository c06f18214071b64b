"""Ink that runs along a part, and lines that only touch it."""

from __future__ import annotations

import numpy as np
from physanimator.rendering.matting.drawn_lines import with_ink

HEIGHT, WIDTH = 90, 120
SKY, RED, INK = (0.62, 0.77, 0.9), (0.8, 0.3, 0.25), (0.12, 0.06, 0.1)
# A red strand with ink on either side, and what a mask has of it.
STRAND, LEFT, RIGHT = slice(30, 50), slice(27, 30), slice(50, 53)

Mask = np.ndarray


def strand() -> tuple[np.ndarray, Mask]:
    """A picture of the strand, and its inside."""
    picture = np.full((HEIGHT, WIDTH, 3), SKY, np.float32)
    picture[10:80, STRAND], picture[10:80, LEFT], picture[10:80, RIGHT] = RED, INK, INK
    inside = np.zeros((HEIGHT, WIDTH), bool)
    inside[10:80, STRAND] = True
    return picture, inside


def test_ink_is_taken_in_a_narrow_gap_and_that_of_the_neighbour_stays() -> None:
    picture, inside = strand()
    picture[:, 56:59], picture[:, 59:90] = INK, RED
    whole = with_ink(picture, inside)
    assert whole[15:75, LEFT].all()
    assert whole[15:75, RIGHT].all()
    assert not whole[:, 54:].any()


def test_lines_that_end_at_the_part_stay() -> None:
    """As those of a shoulder that goes on behind a strand."""
    picture, inside = strand()
    picture[:, 51:53] = SKY
    picture[40:42, 51:110] = INK
    whole = with_ink(picture, inside)
    assert whole[15:75, 50].mean() > 0.9
    assert not whole[:, 52:].any()


def test_a_line_that_runs_alongside_with_something_between_stays() -> None:
    """As an eyelash below a fringe."""
    picture, inside = strand()
    picture[20:70, 54:56] = INK
    assert not with_ink(picture, inside)[:, 54:].any()


def test_hatching_beside_the_part_stays() -> None:
    picture, inside = strand()
    picture[:, 50:] = SKY
    picture[:, 50::4] = picture[:, 51::4] = INK
    assert not with_ink(picture, inside)[:, 53:].any()


def test_a_cut_through_one_colour_stays() -> None:
    picture, inside = strand()
    inside[45:] = False
    assert not with_ink(picture, inside)[49:].any()


def test_a_part_without_an_outline_takes_nothing() -> None:
    """A painted one, beside a still line."""
    picture, inside = strand()
    picture[:, LEFT] = picture[:, RIGHT] = SKY
    picture[30:60, 50:53] = INK
    assert (with_ink(picture, inside) == inside).all()
