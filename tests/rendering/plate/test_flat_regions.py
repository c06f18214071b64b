"""Drawings of flat areas with outlines: both go on behind what has been cut out."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.plate import clean_plate, fill_hole

SIZE = 200, 260
Y, X = np.mgrid[: SIZE[0], : SIZE[1]] + 0.5
SKY, DRESS, INK = (0.55, 0.75, 0.95), (0.85, 0.35, 0.4), (0.15, 0.05, 0.2)
HOLE = np.abs(Y - 70 - 0.1 * (X - 130)) < 26


def drawn(*, outline: float = 0.0, noise: float = 0.0) -> np.ndarray:
    """A dress in front of the sky, 100 px wide at its lower end; its top is covered by the hole."""
    inside = 1 - np.hypot((X - 130) / 60, (Y - 190) / 140)
    signed = inside * 75  # about the distance from the dress's border [px]
    picture = np.where((signed > 0)[..., None], DRESS, SKY)
    if outline:
        picture = np.where((np.abs(signed) < outline / 2)[..., None], INK, picture)
    picture = cv2.GaussianBlur(picture.astype(np.float32), (0, 0), 0.6)
    picture += np.random.default_rng(0).normal(0, noise, picture.shape)
    picture[HOLE] = (0.1, 0.6, 0.1)
    return np.clip(picture, 0, 1).astype(np.float32)


def like(picture: np.ndarray, colour: tuple[float, ...], within: float) -> np.ndarray:
    """Where a picture has about this colour."""
    return np.abs(picture - np.array(colour)).max(axis=2) < within


@pytest.mark.parametrize("noise", [0.0, 0.012])
def test_outlines_go_on_along_continued_borders(noise: float) -> None:
    filled = fill_hole(drawn(outline=4, noise=noise), HOLE)
    deep = cv2.erode(HOLE.astype(np.uint8), np.ones((9, 9))) > 0
    dark = deep & (filled.mean(axis=2) < 0.4)
    assert dark.sum() > 60
    inner = dark & (cv2.erode(dark.astype(np.uint8), np.ones((3, 3))) > 0)
    assert dark.sum() < 6 * max(np.ptp(np.nonzero(dark)[1]), 20) * 2, "no wider than a line"
    if inner.any():
        assert np.abs(np.median(filled[inner], axis=0) - INK).max() < 0.15, "in the outline's colour"


def test_nothing_is_drawn_where_there_are_no_outlines() -> None:
    filled = fill_hole(drawn(), HOLE)
    assert not (HOLE & (filled.mean(axis=2) < 0.45)).any()


def test_gradients_go_on_behind_a_part() -> None:
    """A sky that changes from top to bottom, with a dark hill before it: the sky's colours run on to within a level."""
    sky = np.stack([0.3 + 0.002 * Y, 0.5 + 0.001 * Y, np.full_like(Y, 0.9)], axis=-1)
    picture = np.where((Y > 160)[..., None], (0.2, 0.4, 0.2), sky).astype(np.float32)
    hole = np.hypot(X - 130, Y - 90) < 45
    filled = fill_hole(np.where(hole[..., None], np.float32(0), picture).astype(np.float32), hole)
    assert np.abs(filled - picture)[hole].max() < 0.012


def test_a_strip_along_the_part_does_not_spread_behind_it() -> None:
    """The lit side of a pole, six pixels wide, touches the part all along; behind the part is the sky."""
    picture = np.empty((*SIZE, 3), np.float32)
    picture[:] = SKY
    picture[np.abs(X - 100) < 3] = (0.75, 0.5, 0.25)
    hole = (X > 103) & (X < 200) & (np.abs(Y - 100) < 50)
    picture[hole] = (0.9, 0.1, 0.1)
    filled = fill_hole(picture, hole)
    assert like(filled, SKY, 0.05)[hole & (X > 108)].mean() > 0.97


def test_the_same_picture_gives_the_same_plate() -> None:
    picture = (drawn(outline=4) * 255).round().astype(np.uint8)
    assert (clean_plate(picture, HOLE) == clean_plate(picture, HOLE)).all()
