"""What goes on beyond a picture's border."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.mesh import PixelBox
from physanimator.rendering.composite import on_canvas

SIZE, MARGIN = 96, 14
Y, X = np.mgrid[-MARGIN : SIZE + MARGIN, -MARGIN : SIZE + MARGIN].astype(np.float32)
INSIDE = (slice(MARGIN, -MARGIN),) * 2
AROUND = PixelBox(-MARGIN, -MARGIN, SIZE + MARGIN, SIZE + MARGIN)


def line(slope: float) -> np.ndarray:
    """An ink line through the middle of the bottom border that goes so far to the right on each row."""
    away = np.abs(X - SIZE / 2 - slope * (Y - SIZE)) / np.hypot(1, slope)
    return np.clip(away - 1, 0, 1)[..., None].repeat(3, axis=2).astype(np.float32)


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("slope", [-0.8, 0.0, 0.5])
def test_a_line_goes_on_the_way_it_came(slope: float, turns: int) -> None:
    truth = np.rot90(line(slope), turns)
    found = on_canvas(np.ascontiguousarray(truth[INSIDE]), AROUND)
    beyond = np.rot90((Y >= SIZE) & (X >= 0) & (X < SIZE), turns)
    assert np.abs(found - truth)[beyond].max() < 0.5
    assert np.abs(found - truth)[beyond].mean() < 0.012
    assert (found[INSIDE] == truth[INSIDE]).all()


def test_without_lines_the_border_goes_on() -> None:
    plain = np.random.default_rng(0).uniform(0.4, 0.4 + 1e-3, (SIZE, SIZE)).astype(np.float32)
    assert np.abs(on_canvas(plain, AROUND) - 0.4).max() < 2e-3


def test_a_canvas_within_is_a_crop() -> None:
    picture = np.random.default_rng(0).random((SIZE, SIZE, 4), dtype=np.float32)
    assert (on_canvas(picture, PixelBox(5, 7, 50, 60)) == picture[7:60, 5:50]).all()


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (3, 2)])
def test_the_smallest_pictures_go_on(shape: tuple[int, int]) -> None:
    picture = np.full((*shape, 4), 0.3, np.float32)
    assert np.abs(on_canvas(picture, PixelBox(-4, -5, 20, 21)) - 0.3).max() < 1e-6


def test_a_canvas_elsewhere_shows_what_is_next_to_it() -> None:
    picture = np.full((SIZE, SIZE), 0.3, np.float32)
    assert np.abs(on_canvas(picture, PixelBox(SIZE + 5, -20, SIZE + 9, -10)) - 0.3).max() < 1e-6
    assert on_canvas(picture, PixelBox(SIZE + 5, -20, SIZE + 9, -10)).shape == (10, 4)
