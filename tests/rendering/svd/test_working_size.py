"""The frame that the networks work in."""

from __future__ import annotations

from fractions import Fraction

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


def touched_by(frame: Frame, x: int, y: int) -> set[tuple[int, int]]:
    """Cells, as (row, column), that a pixel of the illustration lies in, by exact fractions."""
    found = []
    for place, length, scaled, side in ((y, frame.height, frame.scaled[1], frame.size[1]),
                                        (x, frame.width, frame.scaled[0], frame.size[0])):  # fmt: skip
        margin = (side - scaled) // 2
        start, end = (margin + Fraction(scaled, length) * each for each in (place, place + 1))
        start, end = (0 if place == 0 else start), (side if place == length - 1 else end)
        found.append([cell for cell in range(side // 8) if start < 8 * cell + 8 and end > 8 * cell])
    return {(row, column) for row in found[0] for column in found[1]}


@pytest.mark.parametrize("seed", range(40))
def test_cells_are_those_that_a_mask_lies_in_for_any_size(seed: int) -> None:
    rng = np.random.default_rng(seed)
    width, height = (int(side) for side in rng.integers(5, 1500, 2))
    frame = Frame.around(width, height, area=int(rng.choice([64 * 64, 448 * 256, 576 * 320])))
    mask, expected = np.zeros((height, width), bool), set()
    corners = [(0, 0), (width - 1, height - 1)] if seed % 2 else []
    for x, y in [*corners, *zip(rng.integers(0, width, 6), rng.integers(0, height, 6), strict=True)]:
        mask[y, x] = True
        expected |= touched_by(frame, int(x), int(y))
    found = frame.cells_touched(mask, cell=8)
    assert found.shape == (frame.size[1] // 8, frame.size[0] // 8)
    assert {(int(row), int(column)) for row, column in np.argwhere(found)} == expected


@pytest.mark.parametrize("size", [(1999, 1301), (333, 777), (4000, 500), (576, 320), (61, 47)])
def test_a_strand_of_one_pixel_is_kept_in_its_whole_length(size: tuple[int, int]) -> None:
    width, height = size
    frame = Frame.around(width, height)
    mask = np.zeros((height, width), bool)
    mask[:, width // 3] = True
    found = frame.cells_touched(mask, cell=8)
    assert found.any(axis=1).all(), "no row of cells lost it"
    assert found.any(axis=0).sum() <= 2 + frame.scaled[0] // width // 8, "and it is no wider than it is"
    assert not frame.cells_touched(~mask & mask, cell=8).any()
    assert frame.cells_touched(mask | ~mask, cell=8).all()
