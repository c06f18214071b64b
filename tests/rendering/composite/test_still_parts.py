"""Only what moves is taken from the drawn frames."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.composite import keep_still_parts, moving_region


def square(left: int) -> np.ndarray:
    alpha = np.zeros((60, 80), np.float32)
    alpha[20:40, left : left + 20] = 1
    return alpha


def test_the_region_is_all_that_is_ever_covered_and_a_soft_edge() -> None:
    region = moving_region([square(10), square(40)], soft_edge=8.0)
    for alpha in (square(10), square(40)):
        assert region[alpha == 1].min() == 1
    assert region[30, 75] == 0
    edge = region[30, 60:70]
    assert (np.diff(edge) <= 0).all()
    assert 0.4 < region[30, 63] < 0.6
    assert region[30, 69] == 0


def test_no_soft_edge_gives_the_bare_region() -> None:
    assert set(np.unique(moving_region([square(10)], soft_edge=0.0))) == {0.0, 1.0}


def test_pixels_outside_are_the_illustrations_and_inside_the_frames() -> None:
    image, frame = np.full((60, 80, 3), 0.2, np.float32), np.full((60, 80, 3), 0.9, np.float32)
    kept = keep_still_parts(frame, image, moving_region([square(10)], soft_edge=4.0))
    np.testing.assert_array_equal(kept[:, 40:], image[:, 40:])
    np.testing.assert_array_equal(kept[20:40, 10:30], frame[20:40, 10:30])


def test_a_picture_that_moves_everywhere_is_taken_whole() -> None:
    assert moving_region([np.ones((4, 5), np.float32)], soft_edge=3.0).min() == 1


def test_a_negative_edge_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="soft_edge"):
        moving_region([square(1)], soft_edge=-1.0)
