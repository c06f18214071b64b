"""The frame that the networks work in."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.networks import Frame


@pytest.mark.parametrize(
    ("size", "frame"),
    [((1920, 1080), (576, 320)), ((576, 320), (576, 320)), ((720, 1280), (320, 576)), ((512, 512), (448, 448))],
)
def test_the_trained_size_for_wide_pictures_and_alike_for_others(size: tuple[int, int], frame: tuple[int, int]) -> None:
    assert Frame.around(*size).size == frame


@pytest.mark.parametrize("size", [(100, 100), (333, 777), (2000, 300), (64, 1000), (1024, 576)])
@pytest.mark.parametrize("area", [576 * 320, 1024 * 576])
def test_sides_are_multiples_of_64_and_proportions_stay(size: tuple[int, int], area: int) -> None:
    frame = Frame.around(*size, area=area)
    assert frame.size[0] % 64 == frame.size[1] % 64 == 0
    assert 0.6 < frame.size[0] * frame.size[1] / area < 1.6
    assert frame.scaled[0] / frame.scaled[1] == pytest.approx(size[0] / size[1], rel=0.02)
    assert min(a / b for a, b in zip(frame.scaled, frame.size, strict=True)) > 0.8


def test_in_and_out_again_is_the_picture() -> None:
    y, x = np.mgrid[:90, :130].astype(np.float32) / 130
    picture = np.stack([x, y, 0.5 + 0.4 * np.sin(6 * x + 4 * y)], axis=2)
    frame = Frame.around(130, 90)
    inward = frame.inward(picture)
    assert inward.shape == (*frame.size[::-1], 3)
    assert np.abs(frame.outward(inward) - picture).max() < 0.02


def test_margins_repeat_the_edge() -> None:
    frame = Frame.around(300, 100, area=64 * 256)
    grey = np.full((100, 300), 0.25, np.float32)
    assert np.abs(frame.inward(grey) - 0.25).max() < 1e-6


def test_an_area_too_small_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="area must be 4096"):
        Frame.around(100, 100, area=1000)
