"""Flat drawings and brushwork: what is behind a part is continued as the rest is drawn."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.plate import fill_hole
from physanimator.rendering.plate.flatness import flat_surroundings

Y, X = np.mgrid[:120, :200] + 0.5
HOLE = (np.abs(X - 100) < 30) & (np.abs(Y - 60) < 35)
DRESS, SKY, INK = (0.62, 0.8, 0.6), (0.45, 0.6, 0.95), (0.1, 0.05, 0.1)


def drawn(noise: float = 0.0) -> np.ndarray:
    """A dress at the left and the sky at the right; both end at the hole, where no line enters it."""
    picture = np.where((X < 100)[..., None], DRESS, SKY).astype(np.float32)
    picture[np.abs(X - 100) < 1.5] = INK
    picture[HOLE] = (1, 0, 1)
    return np.clip(picture + np.random.default_rng(0).normal(0, noise, picture.shape), 0, 1).astype(np.float32)


def texture() -> np.ndarray:
    """Brushwork around the hole, and farther away a quiet margin, as most pictures have one."""
    grain = np.random.default_rng(1).normal(0, 1, (*X.shape, 3)).astype(np.float32)
    painted = np.clip(0.5 + 0.6 * cv2.GaussianBlur(grain, (0, 0), 2.0), 0, 1)
    return np.where((X < 20)[..., None], 0.5, painted).astype(np.float32)


@pytest.mark.parametrize("noise", [0.0, 0.015])
def test_flat_areas_are_told_by_the_noise_of_the_picture(noise: float) -> None:
    flat = flat_surroundings(drawn(noise), HOLE)
    assert flat.share[HOLE].min() > 0.7
    assert flat.noise == pytest.approx(noise, abs=0.006)
    assert not flat_surroundings(texture(), HOLE).share[HOLE].any()


def test_what_is_not_flat_stays_as_it_is() -> None:
    picture = texture()
    assert (flat_surroundings(picture, HOLE).plain == picture)[:, 60:].all()


def test_lines_give_way_to_the_areas_beside_them() -> None:
    plain = flat_surroundings(drawn(), HOLE).plain[20, 60:140]
    apart = np.minimum(np.abs(plain - DRESS).max(axis=1), np.abs(plain - SKY).max(axis=1))
    assert apart.max() < 0.15


@pytest.mark.parametrize("noise", [0.0, 0.015])
def test_between_two_flat_areas_lies_a_border_and_no_fog(noise: float) -> None:
    picture = np.where((Y < 60 + 0.2 * (X - 100))[..., None], DRESS, SKY).astype(np.float32)
    # The border is covered where it would enter the hole, so that nothing can be drawn through it.
    hole = HOLE | ((np.abs(Y - 60 - 0.2 * (X - 100)) < 8) & (np.abs(X - 100) < 60))
    picture = np.clip(picture + np.random.default_rng(0).normal(0, noise, picture.shape), 0, 1).astype(np.float32)
    filled = fill_hole(picture, hole)
    apart = np.minimum(np.abs(filled - DRESS).max(axis=2), np.abs(filled - SKY).max(axis=2))
    mixed = hole & (apart > 0.06 + 3 * noise)
    assert mixed.sum() < 5 * np.ptp(X[hole]), "a border that is a few pixels wide"
    assert (filled[~hole] == picture[~hole]).all()
