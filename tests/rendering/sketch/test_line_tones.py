"""Line drawings of other tools: light on dark, in other sizes."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.sketch import LINE_TONES, dark_lines, has_light_lines, sized_sketch

RANDOM = np.random.default_rng(3)


def drawing(width: int = 320, height: int = 180) -> np.ndarray:
    """Dark lines on white paper."""
    paper = np.full((height, width), 255, np.uint8)
    for _ in range(12):
        a, b = (tuple(int(v) for v in RANDOM.integers(0, (width, height))) for _ in range(2))
        cv2.line(paper, a, b, 0, 3, cv2.LINE_AA)
    return paper.astype(np.float32) / 255


@pytest.mark.parametrize("noise", [0.0, 0.06])
@pytest.mark.parametrize("softness", [0.0, 2.0])
@pytest.mark.parametrize("faint", [1.0, 0.5])
def test_lines_are_told_from_paper(noise: float, softness: float, faint: float) -> None:
    lines = 1 - drawing()
    if softness:
        lines = cv2.GaussianBlur(lines, (0, 0), softness)
    edges = np.clip(faint * lines + RANDOM.normal(0, noise, lines.shape), 0, 1).astype(np.float32)
    assert has_light_lines(edges)
    assert not has_light_lines(1 - edges)
    np.testing.assert_array_equal(dark_lines(edges), 1 - edges)
    np.testing.assert_array_equal(dark_lines(1 - edges), 1 - edges)


def test_a_word_stands_above_the_look() -> None:
    inked = np.zeros((8, 8), np.float32)  # a sketch that is all ink
    inked[:2] = 1
    assert has_light_lines(inked)
    np.testing.assert_array_equal(dark_lines(inked, "dark on light"), inked)
    np.testing.assert_array_equal(dark_lines(1 - inked, "light on dark"), inked)
    assert LINE_TONES[0] == "automatic"
    with pytest.raises(InvalidInputError, match="sketch_lines must be one of automatic"):
        dark_lines(inked, "white")  # type: ignore[arg-type]


@pytest.mark.parametrize("size", [(910, 512), (912, 512), (640, 360), (2560, 1440)])
def test_a_drawing_comes_back_to_the_illustration_s_size(size: tuple[int, int]) -> None:
    """Detectors draw with a shorter side of 512, rounded; lines come to lie where they were."""
    whole = np.ones((720, 1280), np.float32)
    cv2.circle(whole, (900, 300), 120, 0, 9)
    small = cv2.resize(whole, size, interpolation=cv2.INTER_AREA)
    back = sized_sketch(small, 1280, 720)
    assert back.shape == (720, 1280)
    assert np.abs((back < 0.5).astype(int) - (whole < 0.5)).mean() < 0.002
    assert sized_sketch(whole, 1280, 720) is whole


@pytest.mark.parametrize("size", [(512, 512), (720, 1280), (1280, 640)])
def test_a_drawing_of_other_proportions_is_refused(size: tuple[int, int]) -> None:
    with pytest.raises(InvalidInputError, match="1280 x 720 px, or of its proportions"):
        sized_sketch(np.ones(size[::-1], np.float32), 1280, 720)


def test_one_pixel_of_a_tiny_drawing_is_rounding() -> None:
    assert sized_sketch(np.ones((21, 38), np.float32), 1280, 720).shape == (720, 1280)
