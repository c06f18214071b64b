"""Peaks that stand out are those that SciPy finds."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.rendering.peaks import prominent_peaks
from scipy.signal import find_peaks


@pytest.mark.parametrize("levels", [3, 8, 10_000])
def test_they_are_those_that_scipy_finds(levels: int) -> None:
    """Few levels make level tops and equal peaks."""
    random = np.random.default_rng(levels)
    count = 0
    for length in (0, 1, 2, 3, 10, 200):
        for _ in range(20):
            values = random.integers(0, levels, length).astype(float) * (7 / levels)
            for prominence in (0.0, 1.0, 4.0):
                expected, _found = find_peaks(values, prominence=prominence)
                np.testing.assert_array_equal(prominent_peaks(values, prominence), expected)
                count += len(expected)
    assert count > 100
