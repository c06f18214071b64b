"""What a mask probably does not mean is said, and masks as people make them are passed over."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.physics.scene import doubts_about_mask, mask_advice

HEIGHT, WIDTH = 240, 320


def parts() -> np.ndarray:
    """A disc and a strand."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    strand = np.abs(x - 60 - 20 * np.sin(y / 30)) < 4
    return ((np.hypot(x - 200, y - 110) < 60) | (strand & (y > 20) & (y < 220))).astype(np.float32)


def outline(width: int, gap: int = 0) -> np.ndarray:
    line = cv2.circle(np.zeros((HEIGHT, WIDTH), np.uint8), (200, 110), 60, 1, width).astype(np.float32)
    line[100:, 200 - gap // 2 : 200 + (gap + 1) // 2] = 0
    return line


@pytest.mark.parametrize("blur", [0, 2, 8])
def test_masks_as_they_should_be_say_nothing(blur: float) -> None:
    mask = cv2.GaussianBlur(parts(), (0, 0), blur) if blur else parts()
    assert mask_advice(mask) == []
    assert mask_advice(mask > 0.5) == []


def test_a_ring_as_thick_as_a_part_says_nothing() -> None:
    assert doubts_about_mask(outline(30)) == []


@pytest.mark.parametrize("width", [1, 3, 8])
@pytest.mark.parametrize("gap", [0, 5])
@pytest.mark.parametrize("scale", [1, 8])
def test_an_outline_that_is_not_filled_is_told(width: int, gap: int, scale: int) -> None:
    mask = cv2.resize(outline(width, gap), None, fx=scale, fy=scale, interpolation=cv2.INTER_NEAREST)
    (sentence,) = mask_advice(mask)
    assert sentence.startswith("the mask is a line around ")
    assert abs(int(sentence.split()[6]) / scale**2 - np.pi * 57**2) < 1200


def test_a_grey_picture_is_told() -> None:
    noise = np.random.default_rng(0).normal(size=(HEIGHT, WIDTH)).astype(np.float32)
    picture = np.clip(0.5 + 2 * cv2.GaussianBlur(noise, (0, 0), 3), 0, 1)
    (sentence,) = mask_advice(picture)
    assert sentence.startswith("the mask is grey on ")


def test_an_empty_mask_is_for_others_to_refuse() -> None:
    assert mask_advice(np.zeros((HEIGHT, WIDTH))) == []
    assert mask_advice(np.zeros((0, 0))) == []
