"""Which way lines run, and how fast colours change."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.rendering.pictures import StructureTensor, gradients


def test_a_ramp_changes_by_its_slope() -> None:
    row, column = np.indices((12, 15), dtype=np.float32)
    ramp = np.dstack([0.02 * column - 0.01 * row] * 3).astype(np.float32)
    right, down = gradients(ramp)
    assert right.shape == ramp.shape
    assert np.allclose(right[1:-1, 1:-1], 0.02, atol=1e-6)
    assert np.allclose(down[1:-1, 1:-1], -0.01, atol=1e-6)


@pytest.mark.parametrize("degrees", [-80, -45, -10, 0, 30, 75])
def test_lines_run_along_stripes(degrees: float) -> None:
    angle = np.deg2rad(degrees)
    row, column = np.indices((40, 40), dtype=np.float32)
    stripes = np.sin(0.5 * (np.cos(angle) * column + np.sin(angle) * row)).astype(np.float32)
    right, down = gradients(stripes)
    tensor = StructureTensor(*((a * b)[2:-2, 2:-2].mean() for a, b in ((right, right), (right, down), (down, down))))
    assert np.rad2deg(tensor.across) == pytest.approx(degrees, abs=1)
    assert abs(tensor.along @ [np.cos(angle), np.sin(angle)]) < 0.02
    assert tensor.spread == pytest.approx(tensor.xx + tensor.yy, rel=0.01)
