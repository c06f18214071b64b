"""Regions of a picture whose colours go on in one another."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["like_regions"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]


def like_regions(image: FloatImage, free: Mask, *, step: float) -> NDArray[np.int32]:
    """Pixels that hang together by steps between like colours.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3], or with further channels.
        free: the pixels asked for, shape [h, w].
        step: colours of neighbours that are less apart than this are alike.

    Returns:
        The number of each pixel's region, 0 where ``free`` is false; shape [h, w].
    """
    height, width = free.shape
    # Pixels have even coordinates here, and the ways between them odd ones.
    ways = np.zeros((2 * height - 1, 2 * width - 1), dtype=np.uint8)
    ways[::2, ::2] = free
    ways[::2, 1::2] = _alike(image[:, 1:], image[:, :-1], step) & free[:, 1:] & free[:, :-1]
    ways[1::2, ::2] = _alike(image[1:], image[:-1], step) & free[1:] & free[:-1]
    return np.ascontiguousarray(cv2.connectedComponents(ways, connectivity=4)[1][::2, ::2])


def _alike(one: FloatImage, other: FloatImage, step: float) -> Mask:
    difference = one - other
    return np.einsum("ijk,ijk->ij", difference, difference) < step**2
