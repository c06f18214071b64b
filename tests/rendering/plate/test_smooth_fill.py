"""Smooth fills against what they should continue."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from physanimator.rendering.plate import spread_colours
from physanimator.rendering.plate.colour_spreading import spread_sides
from physanimator.rendering.plate.smooth_fill import smooth_fill

HEIGHT, WIDTH = 120, 160
Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5


def test_spread_colours_takes_the_nearest_side() -> None:
    picture = np.zeros((HEIGHT, WIDTH, 3), np.float32)
    picture[:, 80:] = 1
    wanted = (X > 60) & (X < 100)
    filled = spread_colours(picture, ~wanted, wanted)
    assert filled[60, 62].max() < 0.1
    assert filled[60, 97].min() > 0.9
    assert np.diff(filled[60, 60:100, 0]).min() > -1e-3


def test_nothing_known_leaves_the_picture() -> None:
    picture = np.full((20, 30, 3), 0.3, np.float32)
    everywhere = np.ones((20, 30), bool)
    assert (spread_colours(picture, ~everywhere, everywhere) == picture).all()


def test_large_windows_are_spread_at_half_size() -> None:
    picture = np.zeros((700, 900, 3), np.float32)
    picture[:] = np.linspace(0, 1, 900, dtype=np.float32)[:, None]
    wanted = np.zeros((700, 900), bool)
    wanted[300:330, 400:430] = True
    filled = spread_colours(picture, ~wanted, wanted)
    assert np.abs(filled - picture)[wanted].max() < 0.03
    assert (filled[~wanted] == picture[~wanted]).all()


def test_a_plane_of_colour_stays_a_plane() -> None:
    plane = np.stack([X / 200, Y / 200, (X + Y) / 400], axis=-1).astype(np.float32)
    hole = np.hypot(X - 80, Y - 60) < 40
    filled = smooth_fill(np.where(hole[..., None], np.float32(1), plane), hole)
    assert np.abs(filled - plane).max() < 0.06
    assert np.abs(filled - plane)[hole].mean() < 0.015


def test_a_vignette_stays_a_vignette() -> None:
    bowl = np.repeat(0.9 - ((X - 80) ** 2 + (Y - 60) ** 2)[..., None] / 20_000, 3, axis=2).astype(np.float32)
    hole = np.hypot(X - 80, Y - 60) < 40
    filled = smooth_fill(np.where(hole[..., None], np.float32(0), bowl), hole)
    assert np.abs(filled - bowl)[hole].max() < 0.04


def test_little_shines_through_a_line_across_a_deep_hole() -> None:
    picture = np.full((500, 500, 3), 0.2, np.float32)
    picture[250:] = 0.8
    hole = np.zeros((500, 500), bool)
    hole[20:480, 20:480] = True
    hole[247:253] = False
    filled = smooth_fill(np.where(hole[..., None], np.float32(0), picture), hole)
    assert np.abs(filled - picture).max() < 0.15


def test_two_sides_of_a_narrow_hole_meet_sharply() -> None:
    def blurred_columns(spread: Callable[..., NDArray[np.float32]]) -> int:
        row = spread(picture, ~hole, hole, power=5.0)[60, :, 0]
        return int(((row > 0.26) & (row < 0.74)).sum())

    picture = np.full((120, 160, 3), 0.2, np.float32)
    picture[:, 80:] = 0.8
    hole = np.zeros((120, 160), bool)
    hole[10:110, 50:110] = True
    assert blurred_columns(spread_colours) > 2.5 * blurred_columns(spread_sides)


def test_sides_of_like_colours_blend() -> None:
    ramp = np.repeat(np.linspace(0.4, 0.6, 160, dtype=np.float32)[None, :, None], 120, axis=0).repeat(3, axis=2)
    hole = np.zeros((120, 160), bool)
    hole[10:110, 50:110] = True
    filled = spread_sides(ramp, ~hole, hole, power=5.0)
    assert np.abs(np.diff(filled[60, 45:115, 0])).max() < 0.03


def test_sides_of_one_colour_have_one_group() -> None:
    grey = np.full((40, 40, 3), 0.5, np.float32)
    hole = np.zeros((40, 40), bool)
    hole[10:30, 10:30] = True
    assert np.abs(spread_sides(grey, ~hole, hole) - 0.5).max() < 1e-5
