"""Borders in a hole are as soft as those around it, and go on in their own directions."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.plate import fill_hole
from physanimator.rendering.plate.blurring import blurred
from physanimator.rendering.plate.patch_synthesis import continue_texture

HEIGHT, WIDTH = 200, 260
Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5
SKY, CLOUD, HILL = (0.35, 0.6, 0.95), (0.95, 0.95, 1.0), (0.2, 0.4, 0.15)
INK = (0.1, 0.05, 0.15)
# Along a border that comes in from one side alone, lines are not drawn through the hole.
HOLE = np.hypot(X - 150, Y - 100) < 30


def cloud(sigma: float, *, slope: float = 0.2, noise: float = 0.0, outline: float = 0.0) -> np.ndarray:
    """A sky over a cloud; their border is a step blurred by a Gaussian."""
    below = Y - 100 - slope * (X - 130)
    picture = np.where((below > 0)[..., None], CLOUD, SKY)
    if outline:
        picture = np.where((np.abs(below) < outline / 2)[..., None], INK, picture)
    picture = cv2.GaussianBlur(picture, (0, 0), sigma)
    picture += np.random.default_rng(0).normal(0, noise, picture.shape)
    return np.clip(picture, 0, 1).astype(np.float32)


def filled(picture: np.ndarray, hole: np.ndarray = HOLE) -> np.ndarray:
    return fill_hole(np.where(hole[..., None], np.float32((0.8, 0.1, 0.1)), picture).astype(np.float32), hole)


def softness(picture: np.ndarray, column: int) -> float:
    """Deviation of the step's blur along one column, by the integral of t (1 - t) [px]."""
    share = (picture[60:140, column] - CLOUD) @ (np.array(SKY) - CLOUD) / np.square(np.array(SKY) - CLOUD).sum()
    return float(np.sqrt(np.pi) * (share * (1 - share)).sum())


@pytest.mark.parametrize("noise", [0.0, 0.008])
@pytest.mark.parametrize("sigma", [2.0, 4.0, 6.0])
def test_a_soft_border_stays_soft(sigma: float, noise: float, monkeypatch: pytest.MonkeyPatch) -> None:
    _without_lines(monkeypatch)
    plate = filled(cloud(sigma, noise=noise))
    found = np.median([softness(plate, column) for column in range(130, 170)])
    assert 0.6 * sigma < found < 1.5 * sigma


@pytest.mark.parametrize("noise", [0.0, 0.008])
def test_a_sharp_border_stays_sharp(noise: float, monkeypatch: pytest.MonkeyPatch) -> None:
    _without_lines(monkeypatch)
    plate = filled(cloud(0.6, noise=noise))
    assert np.median([softness(plate, column) for column in range(130, 170)]) < 1.3


def test_an_outline_is_no_soft_border(monkeypatch: pytest.MonkeyPatch) -> None:
    _without_lines(monkeypatch)
    plate = filled(cloud(0.6, outline=4.0))
    dark = plate.mean(axis=2) < 0.35
    inner = np.hypot(X - 150, Y - 100) < 25
    assert (dark & inner).any(axis=0)[126:174].mean() > 0.9, "it runs through the hole"
    thick = (dark & inner).sum(axis=0)[126:174]
    assert thick.max() <= 8


def _without_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave the border to the areas: a line with both ends in sight would be drawn in its own profile."""
    monkeypatch.setattr(
        "physanimator.rendering.plate.plate.continue_lines", lambda picture, hole: (picture, np.zeros_like(hole))
    )


@pytest.mark.parametrize("slope", [-1.0, -0.4, 0.0, 0.7])
def test_a_border_goes_on_in_its_direction(slope: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Off the hole's middle, so that halving the way between both sides of the rim would miss it."""
    _without_lines(monkeypatch)
    truth = cloud(0.6, slope=slope)
    plate = filled(truth)
    wrong = HOLE & (np.abs(plate - truth).max(axis=2) > 0.15)
    assert wrong.sum() < 0.07 * HOLE.sum()


def test_stripes_run_through_a_narrow_part_aslant(monkeypatch: pytest.MonkeyPatch) -> None:
    """Colours of the nearest rim would make steps of them."""
    _without_lines(monkeypatch)
    stripe = (Y + 0.5 * X) // 24 % 2 > 0
    truth = cv2.GaussianBlur(np.where(stripe[..., None], HILL, CLOUD), (0, 0), 0.6).astype(np.float32)
    hole = np.abs(X - 130) < 9
    hole[:10] = hole[-10:] = False
    error = np.square(filled(truth, hole) - truth)[hole].mean()
    assert 10 * np.log10(1 / error) > 21


def test_borders_blur_where_directions_around_disagree(monkeypatch: pytest.MonkeyPatch) -> None:
    """From the left the border comes in level, from the right steeply: in the middle nobody knows."""
    _without_lines(monkeypatch)
    straight = cloud(0.6, slope=0.0)
    bent = np.where((X > 130)[..., None], cloud(0.6, slope=1.6), straight).astype(np.float32)
    hole = np.hypot(X - 130, Y - 100) < 45
    widest = [
        max(softness(filled(picture, hole), column) for column in range(120, 140)) for picture in (straight, bent)
    ]
    assert widest[0] < 1.3
    assert widest[1] > 2 * widest[0]


def test_a_picture_is_blurred_by_what_each_place_asks_for() -> None:
    step = np.repeat((X > 130)[..., None], 3, axis=2).astype(np.float32)
    everywhere = np.ones(X.shape, bool)
    for sigma in (1.0, 3.0, 8.0, 20.0):
        found = blurred(step, np.full(X.shape, sigma, np.float32), everywhere)[100, :, 0]
        assert np.sqrt(np.pi) * (found * (1 - found)).sum() == pytest.approx(sigma, rel=0.12)
    half = np.where(Y < 100, 5, 0).astype(np.float32)
    result = blurred(step, half, everywhere)
    assert (result[100:] == step[100:]).all()
    assert 0.3 < result[50, 131, 0] < 0.8


def test_nothing_is_blurred_into_a_picture_that_takes_no_part() -> None:
    picture = np.full((60, 60, 3), 0.5, np.float32)
    picture[:, 30:] = 0
    shown = np.zeros((60, 60), bool)
    shown[:, :30] = True
    result = blurred(picture, np.full((60, 60), 4, np.float32), shown)
    assert np.abs(result - picture).max() < 1e-5


def test_what_ends_in_sight_goes_on_less_far(monkeypatch: pytest.MonkeyPatch) -> None:
    """A bow of 24 px beside the hole, and a wall that leaves the picture, along as much of the rim."""
    _without_lines(monkeypatch)
    hole = np.abs(Y - 100) < 40
    hole &= np.abs(X - 130) < 60
    picture = np.broadcast_to(np.float32(SKY), (*X.shape, 3)).copy()
    picture[(np.abs(X - 130) < 30) & (Y > 139) & (Y < 163)] = HILL
    small = (np.abs(filled(picture, hole) - HILL).max(axis=2) < 0.2) & hole
    picture[(np.abs(X - 130) < 30) & (Y > 139)] = HILL
    large = (np.abs(filled(picture, hole) - HILL).max(axis=2) < 0.2) & hole
    assert small.sum() < 0.85 * large.sum()


def test_patches_are_looked_for_only_where_they_are_wanted() -> None:
    rng = np.random.default_rng(0)
    picture = np.tile(rng.random((8, 8, 3)), (10, 10, 1)).astype(np.float32)
    hole = np.zeros((80, 80), bool)
    hole[20:60, 20:60] = True
    guide = np.full_like(picture, 0.5)
    left = hole & (np.arange(80) < 40)
    result = continue_texture(picture, hole, guide, wanted=left)
    far = hole & ~left
    assert (result[far] == guide[far]).all()
    assert (result[~hole] == picture[~hole]).all()
    assert result[left].std() > 0.1
