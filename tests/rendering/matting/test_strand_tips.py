"""Tips of strands that masks cut off, gaps that they close, and what they leave soft deep inside."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from drawn_shapes import FINE, coverage, filled, grained, over
from physanimator.rendering.matting import moved_edges, regular_mask, soft_alpha
from physanimator.rendering.matting.mask_edges import edge_strength
from physanimator.rendering.matting.mask_forms import edge_of
from physanimator.rendering.matting.strand_ends import coloured_ends, leading_away

HEIGHT, WIDTH = SIZE = (200, 260)
WOOD, INK, PINK, SKY, HAIR = (0.3, 0.05, 0.02), (0.25, 0.1, 0.3), (0.7, 0.25, 0.5), (0.6, 0.75, 0.9), (0.55, 0.3, 0.2)
BODY = [(20, 30), (80, 20), (90, 90), (70, 150), (25, 140)]
# From the body to the right, narrower all the way to its end.
STRAND = [(75, 64), (120, 66), (170, 83), (222, 113), (221, 115), (168, 87), (120, 74), (78, 74)]

Mask = np.ndarray


def outlined(fine: np.ndarray, width: float = 1.5) -> Mask:
    return coverage(cv2.distanceTransform(1 - fine, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) <= width * FINE)


def disc(radius: int) -> np.ndarray:
    return cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1,) * 2)


def drawn() -> tuple[np.ndarray, Mask]:
    """A body with a strand, outlined, in front of something dark; and where both are."""
    fine = filled(SIZE, BODY, STRAND)
    return over(over(grained(SIZE, WOOD), INK, outlined(fine)), PINK, coverage(fine)), outlined(fine)


@pytest.mark.parametrize(("cut", "stops"), [(160, 175), (194, WIDTH)])
def test_a_walk_that_stops_along_a_strand_is_continued_in_its_colours(
    cut: int, stops: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To the end that the colours show, though the mask's edges on either side of its cut are as strong."""
    picture, truth = drawn()
    whole = coverage(filled(SIZE, STRAND, BODY)) > 0.5
    mask, walked = whole & (np.arange(WIDTH) < cut), whole & (np.arange(WIDTH) < stops)
    likely = np.where(whole, np.float32(0.97), np.float32(0.03))
    monkeypatch.setattr(moved_edges, "found_shape", lambda *_: (walked, likely))
    given = mask.astype(np.float32)
    found, moved = moved_edges.searched(picture, given, edge_of(given), reach=10)
    assert moved[whole & ~mask].mean() > 0.9
    assert not found[truth < 0.02].any()


@pytest.mark.parametrize(("wood", "cut"), [(195, 190), (205, 202)])
def test_a_tip_is_judged_by_its_cut_and_not_by_the_edges_beside_it(
    wood: int, cut: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before the cut the strand stands out against the sky, and its tip little against the wood."""
    fine = filled(SIZE, BODY, STRAND)
    behind = np.where((np.arange(WIDTH) < wood)[None, :, None], grained(SIZE, SKY), grained(SIZE, WOOD))
    whole = coverage(fine) > 0.5
    given = (whole & (np.arange(WIDTH) < cut)).astype(np.float32)
    likely = np.where(whole, np.float32(0.97), np.float32(0.03))
    monkeypatch.setattr(moved_edges, "found_shape", lambda *_: (whole, likely))
    _, moved = moved_edges.searched(over(behind, PINK, coverage(fine)), given, edge_of(given), reach=10)
    assert moved[whole & (given == 0)].mean() > 0.9


def test_ends_go_on_from_strands_that_a_mask_has_and_from_no_others() -> None:
    fine = filled(SIZE, STRAND, BODY)
    whole = coverage(fine) > 0.5
    known = whole & (np.arange(WIDTH) < 160)
    beyond = whole & ~known
    assert coloured_ends(known, whole, known)[beyond].mean() > 0.95
    body = coverage(filled(SIZE, BODY)) > 0.5
    assert not coloured_ends(known, whole, body).any()


def test_what_lies_along_a_mask_does_not_lead_away_from_it() -> None:
    whole = coverage(filled(SIZE, STRAND, BODY)) > 0.5
    assert not leading_away(cv2.dilate(whole.astype(np.uint8), disc(3)) > 0, whole).any()
    known = whole & (np.arange(WIDTH) < 190)
    assert leading_away(whole, known)[whole & ~known].mean() > 0.95


def test_edges_that_two_shapes_share_do_not_count() -> None:
    """The cut across a strand is within one colour, and its sides are not."""
    whole = coverage(filled(SIZE, [(20, 90), (220, 90), (220, 98), (20, 98)])) > 0.5
    cut = whole & (np.arange(WIDTH) < 150)
    picture = over(grained(SIZE, SKY), PINK, whole.astype(np.float32))
    at = (94, 150)
    assert edge_strength(picture, cut)[at] > 0.1
    assert edge_strength(picture, cut, apart_from=whole)[at] < 0.02
    assert edge_strength(picture, whole, apart_from=cut)[at] > 0.1


def test_what_is_seen_through_a_gap_that_a_mask_has_closed_is_no_part_of_it() -> None:
    """Beyond the gap lies something else, and the sky is seen elsewhere only."""
    ribbon = filled(SIZE, [(40, 60), (210, 50), (210, 80), (40, 90)])
    hair = filled(SIZE, [(0, 106), (260, 98), (260, 200), (0, 200)])
    picture = over(over(grained(SIZE, SKY), INK, outlined(hair)), HAIR, coverage(hair))
    picture = over(over(picture, INK, outlined(ribbon)), (0.95, 0.75, 0.2), coverage(ribbon))
    mask = cv2.dilate((outlined(ribbon) > 0.5).astype(np.float32), disc(9))
    gap = (outlined(ribbon, 2.5) < 0.02) & (outlined(hair, 2.5) < 0.02) & (np.arange(HEIGHT)[:, None] > 70) & (mask > 0)
    assert gap[:, 50:200].sum() > 500
    found = regular_mask(picture, mask) > 0.5
    assert found[gap & (np.abs(np.arange(WIDTH) - 125) < 75)].mean() < 0.1
    assert found[coverage(ribbon) > 0.9].mean() > 0.99


def test_what_a_mask_leaves_soft_deep_inside_does_not_blacken_what_is_behind() -> None:
    mask = np.zeros((60, 60), np.float32)
    mask[10:50, 10:50] = 1
    mask[25:35, 25:35] = 0.85
    picture, plate = np.full((2, 60, 60, 3), 0.8, np.float32)
    picture[10:50, 10:50] = 0.02
    alpha = soft_alpha(picture, plate, mask, mask > 0)
    assert alpha[25:35, 25:35].min() > 0.95
    veil = np.where(mask[..., None] == np.float32(0.85), 0.15 * plate + 0.85 * picture, picture).astype(np.float32)
    assert np.allclose(soft_alpha(veil, plate, mask, mask > 0)[25:35, 25:35], 0.85, atol=0.02)
