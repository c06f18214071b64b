"""Laying resampled layers over what is behind them."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.rendering.composite.laying import as_planes, lay_over


@pytest.mark.parametrize("channels", [4, 5])
def test_a_layer_that_overshoots_is_laid_without_a_fringe(channels: int) -> None:
    layer = np.random.default_rng(0).uniform(-0.3, 1.3, (9, 7, channels)).astype(np.float32)
    planes = as_planes(layer)
    alpha = np.clip(layer[..., -1], 0, 1)
    assert np.array_equal(planes[..., -1], alpha)
    assert np.array_equal(planes[..., :-1], np.minimum(np.maximum(layer[..., :-1], 0), alpha[..., None]))
    below = np.random.default_rng(1).uniform(0, 1, (channels - 1, 9, 7)).astype(np.float32)
    laid = below.copy()
    lay_over(laid, planes)
    np.testing.assert_allclose(laid, below * (1 - alpha) + np.moveaxis(planes[..., :-1], 2, 0), atol=1e-6)
    assert laid.min() >= 0
    assert laid.max() <= 1 + 1e-6


def test_a_clean_layer_is_taken_as_it_is() -> None:
    layer = np.random.default_rng(2).uniform(0, 1, (5, 6, 4)).astype(np.float32)
    assert np.array_equal(as_planes(layer, clean=True), layer)
