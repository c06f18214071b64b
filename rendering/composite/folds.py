"""Where a moved mesh lies over itself, and its own edges would show steps."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox
from .places import NOWHERE

__all__ = ["torn_tiles"]

Mask = NDArray[np.bool_]

# Neighbouring pixels that come from places farther apart than this are of different sheets [px].
_APART = 4.0
_TILE = 32


def torn_tiles(x: NDArray[np.float32], y: NDArray[np.float32]) -> Iterator[tuple[PixelBox, Mask]]:
    """Tiles of a picture in which neighbours come from places far apart, and these pixels.

    Args:
        x: column that each pixel shows, NOWHERE off the mesh, shape [h, w].
        y: row, of the same shape.

    Yields:
        The tile and its torn pixels, shape [tile height, tile width].
    """
    height, width = x.shape
    torn = np.zeros((height, width), dtype=bool)
    there = x > NOWHERE / 2
    for before, after in (
        ((slice(None), slice(None, -1)), (slice(None), slice(1, None))),
        ((slice(None, -1), slice(None)), (slice(1, None), slice(None))),
    ):
        jump = (np.abs(x[after] - x[before]) > _APART) | (np.abs(y[after] - y[before]) > _APART)
        jump &= there[after] & there[before]
        torn[after] |= jump
        torn[before] |= jump
    for top in range(0, height, _TILE):
        rows = torn[top : top + _TILE]
        if not rows.any():
            continue
        for left in range(0, width, _TILE):
            part = rows[:, left : left + _TILE]
            if part.any():
                yield PixelBox(left, top, left + part.shape[1], top + part.shape[0]), part
