"""The nearest pixels, and amounts set down between pixels."""

from __future__ import annotations

import numpy as np
from physanimator.rendering.pictures import nearest_pixels, splat


def test_the_nearest_pixel_is_as_far_as_is_said() -> None:
    where = np.zeros((30, 40), bool)
    where[[4, 20, 25], [5, 30, 8]] = True
    distance, nearest = nearest_pixels(where)
    row, column = np.indices(where.shape)
    exact = [np.hypot(row - y, column - x) for y, x in zip(*np.nonzero(where), strict=True)]
    chosen = np.hypot(row - nearest // 40, column - nearest % 40)
    assert where.ravel()[nearest].all()
    assert (chosen <= 1.05 * np.min(exact, axis=0)).all()
    assert np.abs(distance - chosen).max() <= 0.05 * chosen.max()
    assert np.array_equal(nearest[where], np.flatnonzero(where))


def test_an_amount_is_shared_among_four_pixels() -> None:
    x, y, amount = np.array([1.25]), np.array([2.5]), np.array([8.0])
    (plane,) = splat(x, y, [amount], (5, 4))
    assert plane[2:4, 1:3].tolist() == [[3.0, 1.0], [3.0, 1.0]]
    assert plane.sum() == 8.0
    (outside,) = splat(np.array([-0.5]), np.array([0.0]), [amount], (5, 4))
    assert outside.sum() == outside[0, 0] == 4.0
