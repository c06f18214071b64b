"""Ends of parts that rough masks have cut off, and outlines in front of what is as dark as they are."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from drawn_shapes import FINE, coverage, filled, grained, over
from physanimator.rendering.matting import regular_mask, regularisation
from physanimator.rendering.matting.outline_colour import coloured_outline
from physanimator.rendering.matting.strand_ends import strand_ends

HEIGHT, WIDTH = SIZE = (200, 180)
SKY, RED = (0.6, 0.75, 0.9), (0.55, 0.2, 0.45)
# The ink is seen by its hue only in front of the wood.
WOOD, INK = (0.32, 0.05, 0.02), (0.2, 0.08, 0.2)
TIP = [(50, 20), (130, 20), (120, 90), (105, 150), (95, 170), (80, 110), (60, 80)]

Mask = np.ndarray


def rough(alpha: Mask, cut: int) -> Mask:
    """Too wide on the left, too tight on the right, and straight across near its end."""
    hard, disc = (alpha > 0.5).astype(np.float32), cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (7, 7))
    left = np.arange(WIDTH) < 90
    mask = np.where(left, cv2.dilate(hard, disc), cv2.erode(hard, disc))
    mask[cut:] = 0
    return mask


@pytest.mark.parametrize("lost", [14, 24])
def test_an_end_is_found_that_a_rough_mask_has_cut_off(lost: int) -> None:
    """Further from the mask than its edge may be wrong: nothing but the end of the part divides the two."""
    alpha = coverage(filled(SIZE, TIP))
    end = (alpha > 0.9) & (np.arange(HEIGHT)[:, None] > 170 - lost)
    found = regular_mask(over(grained(SIZE, SKY), RED, alpha), rough(alpha, 170 - lost)) > 0.5
    assert found[end].mean() > 0.95
    assert not found[alpha < 0.02].any()


def test_a_careful_mask_may_end_within_one_colour() -> None:
    alpha = coverage(filled(SIZE, TIP))
    mask = np.where(np.arange(HEIGHT)[:, None] < 150, alpha, np.float32(0))
    assert not (regular_mask(over(grained(SIZE, SKY), RED, alpha), mask) > 0.5)[152:].any()


def outlined(fine: np.ndarray, width: float = 2) -> Mask:
    return coverage(cv2.distanceTransform(1 - fine, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) <= width * FINE)


def test_an_outline_is_found_by_its_colour_in_front_of_what_is_as_dark() -> None:
    """By its lightness only beside the wood, in front of the sky."""
    fine = filled(SIZE, [(20, 60), (160, 60), (160, 90), (20, 90)])
    wooden = np.abs(np.arange(WIDTH) - 110) < 25
    behind = np.where(wooden[None, :, None], grained(SIZE, WOOD), grained(SIZE, SKY))
    picture = over(over(behind, INK, outlined(fine)), RED, coverage(fine))
    shape, along = coverage(fine) > 0.5, np.abs(np.arange(WIDTH) - 110) < 15
    found = coloured_outline(picture, shape, reach=5)
    assert found[(outlined(fine) > 0.9) & ~shape & along].mean() > 0.9
    assert not found[(outlined(fine, 3.5) < 0.02) & along].any()
    assert not found[shape].any()


def test_no_outline_is_found_beside_something_wide_of_its_colour() -> None:
    fine = filled(SIZE, [(20, 60), (160, 60), (160, 90), (20, 90)])
    behind = np.where((np.abs(np.arange(WIDTH) - 110) < 25)[None, :, None], grained(SIZE, WOOD), grained(SIZE, SKY))
    ground = coverage(filled(SIZE, [(0, 90), (180, 90), (180, 96), (0, 96)]))
    picture = over(over(over(behind, INK, outlined(fine)), INK, ground), RED, coverage(fine))
    below = (np.arange(HEIGHT)[:, None] > 92) & (np.abs(np.arange(WIDTH) - 110) < 15)
    assert not coloured_outline(picture, coverage(fine) > 0.5, reach=5)[below].any()


def tapering(*, bend: float = 0) -> tuple[np.ndarray, Mask, Mask]:
    """A strand that fades into another colour as it tapers, what of it is known, and its end, which may be bent."""
    strand = filled(SIZE, [(20, 67), (100, 68), (100, 72), (20, 73)])
    end = filled(SIZE, [(99, 68), (140, 69 + bend), (140, 71 + bend), (99, 72)])
    fade = np.clip((np.arange(WIDTH) - 90) / 50, 0, 1).astype(np.float32)
    picture = over(
        over(grained(SIZE, SKY), RED, coverage(strand | end)), (0.3, 0.3, 0.7), coverage(strand | end) * fade
    )
    known = coverage(strand) > 0.5
    return picture, known, (coverage(end) > 0.6) & ~known


def test_the_end_of_a_strand_is_followed_to_where_it_fades() -> None:
    picture, known, end = tapering()
    found = strand_ends(picture, known, known)
    assert found[end].mean() > 0.9
    assert (found & ~end).sum() < 0.3 * end.sum()


def test_a_line_that_leaves_a_strand_in_another_direction_is_not_its_end() -> None:
    picture, known, end = tapering(bend=60)
    assert not strand_ends(picture, known, known)[end].any()


def test_a_line_that_goes_on_from_something_wide_is_no_strands_end() -> None:
    picture, known, _ = tapering()
    wide = known | (coverage(filled(SIZE, [(20, 30), (100, 30), (100, 110), (20, 110)])) > 0.5)
    assert not strand_ends(picture, wide, wide).any()


def shrunk(alpha: Mask, radius: int = 4) -> Mask:
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1,) * 2)
    return cv2.erode((alpha > 0.5).astype(np.float32), disc)


def test_a_part_at_the_border_of_the_picture_is_looked_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing goes on beyond the picture."""
    looked: list[tuple[int, ...]] = []
    made = regularisation._REGULAR

    def counted(image: np.ndarray, mask: Mask) -> Mask:
        looked.append(mask.shape)
        return made(image, mask)

    monkeypatch.setattr(regularisation, "_REGULAR", counted)
    alpha = coverage(filled(SIZE, [(70, 120), (110, 120), (110, 200), (70, 200)]))
    found = regular_mask(over(grained(SIZE, SKY), RED, alpha), shrunk(alpha))
    assert found[-1].max() == 1
    assert len(looked) == 1
