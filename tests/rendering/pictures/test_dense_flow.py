"""The motion that is seen between two pictures."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.pictures import LEAST_FLOW_SIDE, optical_flow


def texture(height: int, width: int) -> np.ndarray:
    noise = np.random.default_rng(3).uniform(0, 255, (height, width)).astype(np.float32)
    blurred = cv2.GaussianBlur(noise, (0, 0), 2.5)
    return cv2.normalize(blurred, None, 0, 255, cv2.NORM_MINMAX).astype(np.uint8)


def test_a_shifted_texture_moves_by_its_shift() -> None:
    whole = texture(80, 120)
    flow = optical_flow(whole[:, 10:110], whole[:, 7:107])
    assert flow.shape == (80, 100, 2)
    assert np.median(flow[..., 0]) == pytest.approx(3, abs=0.1)
    assert np.median(flow[..., 1]) == pytest.approx(0, abs=0.1)


@pytest.mark.parametrize("side", [1, 8, LEAST_FLOW_SIDE - 1, LEAST_FLOW_SIDE])
def test_small_pictures_are_survived(side: int) -> None:
    first, second = texture(side, 40), texture(side, 40)[:, ::-1]
    flow = optical_flow(first, np.ascontiguousarray(second))
    assert flow.shape == (side, 40, 2)
    assert np.isfinite(flow).all()
    assert flow.any() == (side >= LEAST_FLOW_SIDE)
