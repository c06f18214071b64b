"""Coordinates, colours and masks between a picture and a network's square."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from physanimator.rendering.segmentation.sam.families import FAMILIES
from physanimator.rendering.segmentation.sam.pictures import Square

SIZES = [(1280, 720), (719, 1283), (64, 64), (3000, 37), (1, 500), (333, 1000)]
Families = pytest.mark.parametrize("family", [FAMILIES["sam"], FAMILIES["sam2"]], ids=lambda family: family.title)


@Families
@pytest.mark.parametrize(("width", "height"), SIZES)
def test_corners_of_the_picture_are_corners_of_what_the_network_sees(family, width: int, height: int) -> None:
    square = Square(width, height, 256, family.stretched)
    columns, rows = square.size
    corners = square.coordinates([(0, 0), (width, height)]) + 0.5
    torch.testing.assert_close(corners, torch.tensor([[0.0, 0.0], [columns, rows]]))
    assert max(columns, rows) == 256


@Families
@pytest.mark.parametrize(("width", "height"), [(640, 360), (361, 640), (900, 250), (256, 256)])
def test_a_point_lands_on_the_pixel_that_was_clicked(family, width: int, height: int) -> None:
    """A small bright square in the picture is where its centre's coordinates say, to a tenth of a pixel."""
    square = Square(width, height, 256, family.stretched)
    for x, y in ((width * 0.25, height * 0.75), (width * 0.8, height * 0.3)):
        column, row = int(x), int(y)
        image = np.zeros((height, width, 3), np.uint8)
        image[row - 4 : row + 5, column - 4 : column + 5] = 255
        light = square.pixels(image, family)[0, 1]
        light = (light - light.min()) * (light > light.max() / 2 + light.min() / 2)
        indices = torch.arange(256, dtype=torch.float32)
        centre = torch.stack([(light.sum(0) * indices).sum(), (light.sum(1) * indices).sum()]) / light.sum()
        torch.testing.assert_close(centre, square.coordinates((column + 0.5, row + 0.5)), atol=0.6, rtol=0)


@Families
@pytest.mark.parametrize(("width", "height"), [(640, 360), (361, 640), (900, 250)])
def test_a_mask_comes_back_to_where_it_was(family, width: int, height: int) -> None:
    """A half plane, drawn in the network's own grid of a quarter of the square, has its edge in the right place."""
    square = Square(width, height, 256, family.stretched)
    edge = square.coordinates([(width * 0.4, 0)])[0, 0].item()
    positions = (torch.arange(64) + 0.5) * 4 - 0.5
    low = (edge - positions).expand(1, 64, 64)
    mask = square.logits(low)[0] > 0
    assert mask.shape == (height, width)
    assert np.abs(mask.sum(axis=1) - width * 0.4).max() <= 1


def test_what_lies_beyond_the_picture_is_of_the_mean_colour_and_colours_are_evened() -> None:
    family = FAMILIES["sam"]
    pixels = Square(64, 32, 64, False).pixels(np.full((32, 64, 3), 255, np.uint8), family)
    assert pixels.shape == (1, 3, 64, 64)
    assert not pixels[..., 32:, :].any()
    expected = (1 - torch.tensor(family.mean)) / torch.tensor(family.std)
    torch.testing.assert_close(pixels[0, :, 5, 5], expected)
