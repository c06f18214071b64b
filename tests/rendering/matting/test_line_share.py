"""The shares of a drawn outline's pixels."""

from __future__ import annotations

import numpy as np
from physanimator.rendering.matting.line_share import share_of_line

# Across a vertical line: background, a rim of one half, two full columns, a rim of one fifth, background.
SHARES = np.array([0.0, 0.5, 1.0, 1.0, 0.2, 0.0])


def shares(line_colour: tuple[float, ...], background: tuple[float, ...]) -> np.ndarray:
    share = np.tile(SHARES, (5, 1))[..., None]
    behind = np.broadcast_to(np.array(background, dtype=np.float32), (5, 6, 3))
    image = (share * line_colour + (1 - share) * behind).astype(np.float32)
    everywhere = np.ones((5, 6), dtype=bool)
    return share_of_line(image, behind, everywhere, everywhere, faintest=0.1).reshape(5, 6)


def test_a_rim_shows_the_background_through() -> None:
    for line_colour in ((0.1, 0.05, 0.2), (0.95, 0.9, 0.9)):
        assert np.abs(shares(line_colour, (0.6, 0.7, 0.5)) - SHARES).max() < 0.08


def test_what_looks_like_the_background_is_none_of_the_line() -> None:
    assert shares((0.61, 0.7, 0.5), (0.6, 0.7, 0.5)).max() < 0.15


def test_a_share_is_enough_for_a_colour_that_exists() -> None:
    image = np.array([[[0.02, 0.3, 0.4], [0.4, 0.0, 0.0]]], dtype=np.float32)
    behind = np.full_like(image, 0.5)
    both = np.ones((1, 2), dtype=bool)
    found = share_of_line(image, behind, both, both, faintest=0.1)
    colour = (image[0] - (1 - found[:, None]) * 0.5) / found[:, None]
    assert colour.min() > -1e-5
