"""Colours spread by distance, against sums over all pairs of pixels."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.rendering.plate.colour_spreading import _by_distance


@pytest.mark.parametrize("power", [2.0, 5.0])
@pytest.mark.parametrize("seed", range(3))
def test_sums_are_those_over_all_pairs(seed: int, power: float) -> None:
    random = np.random.default_rng(seed)
    height, width = random.integers(9, 30, 2)
    picture = random.random((height, width, 4)).astype(np.float32)
    picture[..., 3] = 0  # nothing, as of what is flat in a photograph
    known = random.random((height, width)) < 0.2
    wanted = ~known & (random.random((height, width)) < 0.7)
    groups = random.integers(0, 3, int(known.sum())).astype(np.int32)
    groups[:3] = range(3)
    weights, sums = _by_distance(picture, known, wanted, groups, power)
    apart = np.argwhere(known)[:, None] - np.argwhere(wanted)
    weight = ((apart**2).sum(axis=2) + 0.5) ** (-power / 2)
    for k in range(3):
        own = groups == k
        np.testing.assert_allclose(weights[k], weight[own].sum(axis=0), rtol=1e-6)
        for channel in range(4):
            expected = (weight[own] * picture[known][own, channel][:, None]).sum(axis=0)
            np.testing.assert_allclose(sums[k, channel], expected, rtol=1e-6)
    assert not sums[:, 3].any()
