"""Outlines that a mask leaves out where little tells of them: in narrow gaps, and in front of what is as dark."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from drawn_shapes import FINE, coverage, over
from physanimator.rendering.matting import with_outline

SIZE = 160
SKY, SKIN, INK = (0.85, 0.9, 1.0), (0.95, 0.8, 0.7), (0.3, 0.08, 0.3)
# Seen behind the lower half: in the mean as light as the ink, in other colours.
SHADE = (0.05, 0.25, 0.05)


def drawn(fine: np.ndarray, behind: np.ndarray, line: float = 2.5) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A part with its outline over what is behind it; its alpha, and its mask without the outline."""
    inner = cv2.distanceTransform(fine, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) > line * FINE
    picture = over(over(behind, INK, coverage(fine)), SKIN, coverage(inner))
    return picture, coverage(fine), (coverage(inner) > 0.5).astype(np.float32)


def disc(radius: float, at: tuple[float, float] = (80, 80)) -> np.ndarray:
    y, x = np.mgrid[: SIZE * FINE, : SIZE * FINE] / FINE
    return (np.hypot(x - at[0], y - at[1]) < radius).astype(np.uint8)


@pytest.mark.parametrize("width", [3, 4, 5])
def test_the_outline_in_a_gap_narrower_than_it_may_reach_is_found(width: int) -> None:
    """As between a strand and a face: nowhere in the gap is anything far from the part."""
    fine = disc(60)
    fine[30 * FINE : 110 * FINE, 70 * FINE : (70 + width) * FINE] = 0
    picture, alpha, mask = drawn(fine, np.full((SIZE, SIZE, 3), SKY, np.float32))
    support = with_outline(picture, mask)
    gap = np.zeros((SIZE, SIZE), bool)
    gap[40:100, 66 : 74 + width] = True
    assert support[gap & (alpha > 0.6)].mean() > 0.98
    assert not support[40:100, 70 + width // 2].any()


def shaded(spots: float) -> np.ndarray:
    rng = np.random.default_rng(0)
    noise = cv2.GaussianBlur(rng.normal(0, 1, (SIZE, SIZE, 1)).astype(np.float32), (0, 0), 3)[..., None]
    behind = np.full((SIZE, SIZE, 3), SKY, np.float32)
    behind[SIZE // 2 :] = np.clip(np.float32(SHADE) * (1 + spots * noise / noise.std()), 0, 1)[SIZE // 2 :]
    return behind


@pytest.mark.parametrize("spots", [0.0, 0.3])
def test_an_outline_goes_on_in_its_ink_in_front_of_what_is_as_dark(spots: float) -> None:
    picture, alpha, mask = drawn(disc(55), shaded(spots))
    support = with_outline(picture, mask)
    y, x = np.mgrid[:SIZE, :SIZE]
    below = (y > 90) & (alpha > 0.6)
    assert support[below].mean() > 0.95
    assert not support[np.hypot(x + 0.5 - 80, y + 0.5 - 80) > 55 + 3].any()


def test_a_mask_that_has_its_outline_does_not_get_a_line_beside_it() -> None:
    """The line is of the same ink, and something else's."""
    picture, alpha, _ = drawn(disc(55), shaded(0.3))
    y, x = np.mgrid[:SIZE, :SIZE] + 0.5
    other = np.clip(1.5 - np.abs(np.hypot(x - 80, y - 80) - 59), 0, 1) * (y > 100)
    picture = over(picture, INK, other.astype(np.float32))
    assert not with_outline(picture, (alpha > 0.5).astype(np.float32))[other > 0.5].any()
