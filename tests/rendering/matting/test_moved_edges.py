"""How far a mask lies from the part's edge where the picture shows it, and what follows where it does not."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.matting import regular_mask
from physanimator.rendering.matting.moved_edges import displacement, expected, without_new_specks

PAPER, RED = (0.9, 0.92, 0.95), (0.7, 0.2, 0.25)


def ribbon() -> tuple[np.ndarray, np.ndarray]:
    """A red ribbon that goes on below the part, and the part, which ends within it at row 90."""
    picture = np.full((160, 140, 3), PAPER, np.float32)
    picture[20:, 40:100] = RED
    part = np.zeros((160, 140), bool)
    part[20:90, 40:100] = True
    return picture, part


def resized(part: np.ndarray, radius: int) -> np.ndarray:
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * abs(radius) + 1,) * 2)
    return (cv2.dilate if radius > 0 else cv2.erode)(part.astype(np.uint8), disc) > 0


@pytest.mark.parametrize("radius", [-5, -2, 0, 2, 5])
def test_clear_edges_tell_how_much_a_mask_was_grown(radius: int) -> None:
    picture, part = ribbon()
    given = resized(part, radius) if radius else part
    middle, spread = displacement(picture, part, given)
    assert middle == pytest.approx(-radius, abs=0.3)
    assert spread < 0.5


def test_a_picture_without_edges_tells_nothing() -> None:
    _, part = ribbon()
    assert displacement(np.full((160, 140, 3), RED, np.float32), part, part) == (0.0, 0.0)


@pytest.mark.parametrize("radius", [-5, -3, 3, 5])
def test_a_cut_within_one_colour_goes_back_to_where_it_was(radius: int) -> None:
    picture, part = ribbon()
    given = resized(part, radius)
    # The sides and the top have been found; below there is no edge.
    found = np.where(np.arange(160)[:, None] < 84, part, given)
    again = expected(picture, found, given)
    assert (again != part).sum() < 90
    assert (found != part).sum() > 150


@pytest.mark.parametrize("radius", [-5, 5])
def test_a_hard_mask_that_was_grown_or_shrunk_is_mended_where_the_picture_shows_no_edge(radius: int) -> None:
    picture, part = ribbon()
    mask = regular_mask(picture, resized(part, radius).astype(np.float32)) > 0.5
    assert (mask != part).sum() < 90


@pytest.mark.parametrize("sigma", [2.0, 5.0])
def test_a_cut_of_a_mask_that_is_only_blurred_stays(sigma: float) -> None:
    picture, part = ribbon()
    blurred = cv2.GaussianBlur(part.astype(np.float32), (0, 0), sigma)
    mask = regular_mask(picture, blurred) > 0.5
    assert (mask != part).sum() < 90


def test_where_masks_miss_by_various_amounts_nothing_is_expected() -> None:
    picture, part = ribbon()
    left = np.arange(140) < 85
    given = np.where(left, resized(part, 5), resized(part, -5))
    assert (expected(picture, part, given) == part).all()


def test_specks_that_moving_an_edge_has_made_go_and_those_of_the_mask_stay() -> None:
    given = np.zeros((60, 60), bool)
    given[20:50, 20:50] = True
    given[5:7, 5:7], given[40:42, 40:42] = True, False
    shape = given.copy()
    shape[10:12, 30:32], shape[30:32, 30:32], shape[25:30, 42:50] = True, False, False
    wanted = given.copy()
    wanted[25:30, 42:50] = False
    assert (without_new_specks(shape, given) == wanted).all()
