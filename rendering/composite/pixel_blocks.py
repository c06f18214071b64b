"""Whether a picture is pixel art, and how large its pixels are drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["block_size", "looks_like_pixel_art", "pixel_art_hint"]

# Art of fewer pixels on a side is rather a picture of large squares.
_FEWEST_BLOCKS = 16
# Pixel art has few colours and is small, once its blocks are counted as pixels. Drawings with soft edges have far more
# colours at such sizes: the bundled example and three others 9,000 and more at 320 px, and over 260 still at 32 px.
_MOST_COLOURS = 64
_LONGEST_SIDE = 320


def block_size(image: NDArray[Any]) -> int:
    """Side of the squares of one colour that a picture is made of [px]; 1 where it is not.

    Args:
        image: shape [h, w, c].
    """
    height, width = image.shape[:2]
    down = np.flatnonzero((image[1:] != image[:-1]).any(axis=(1, 2))) + 1
    across = np.flatnonzero((image[:, 1:] != image[:, :-1]).any(axis=(0, 2))) + 1
    block = int(np.gcd.reduce([height, width, *down, *across]))
    # A picture of a few large shapes tells nothing about its pixels.
    return block if block * _FEWEST_BLOCKS <= min(height, width) else 1


def looks_like_pixel_art(image: NDArray[Any]) -> bool:
    """Whether a picture is small, once its blocks are counted as pixels, and has few colours.

    Args:
        image: RGB or RGBA, shape [h, w, c].
    """
    block = block_size(image)
    small = np.ascontiguousarray(image[::block, ::block])
    if max(small.shape[:2]) > _LONGEST_SIDE:
        return False
    return len(np.unique(small.reshape(-1, small.shape[2]), axis=0)) <= _MOST_COLOURS


def pixel_art_hint(image: NDArray[Any], *, option: str) -> list[str]:
    """A sentence for a picture that looks like pixel art and is not treated as such.

    Args:
        image: RGB or RGBA, shape [h, w, c].
        option: what would do so.
    """
    if not looks_like_pixel_art(image):
        return []
    height, width = image.shape[:2]
    return [f"the picture looks like pixel art ({width} x {height} px, few colours); {option} keeps its pixels hard"]
