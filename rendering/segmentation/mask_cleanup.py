"""Cleaning a mask: specks go, holes are filled, the edge is smoothed."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require

__all__ = ["clean_mask"]

Mask = NDArray[np.bool_]


def clean_mask(mask: Mask, *, smallest_speck: int = 0, largest_hole: int = 0, smoothing: float = 0.0) -> Mask:
    """A mask without specks and holes, and with a smooth edge.

    Args:
        mask: shape [h, w].
        smallest_speck: connected parts of fewer pixels are left out, but never the largest one [px^2].
        largest_hole: gaps of up to so many pixels are filled [px^2].
        smoothing: radius of the bays and spikes that are evened out [px].

    Returns:
        The cleaned mask, shape [h, w].

    Raises:
        InvalidInputError: a size is negative.
    """
    for name, value in (("smallest_speck", smallest_speck), ("largest_hole", largest_hole), ("smoothing", smoothing)):
        require(name, value, value >= 0, "at least 0")
    smooth = _smoothed(mask, smoothing) if smoothing > 0 else mask
    return _without_specks(_filled(smooth, largest_hole), smallest_speck)


def _smoothed(mask: Mask, radius: float) -> Mask:
    # A straight edge stays where it is under any symmetric blur; beyond the border the mask goes on.
    blurred = cv2.GaussianBlur(mask.astype(np.float32), (0, 0), radius, borderType=cv2.BORDER_REPLICATE)
    return blurred > 0.5


def _filled(mask: Mask, largest_hole: int) -> Mask:
    _, labels, statistics, _ = cv2.connectedComponentsWithStats((~mask).astype(np.uint8), connectivity=4)
    small = statistics[:, cv2.CC_STAT_AREA] <= largest_hole
    small[0] = False
    return mask | small[labels]


def _without_specks(mask: Mask, smallest: int) -> Mask:
    count, labels, statistics, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    if count < 2:
        return mask
    keep = statistics[:, cv2.CC_STAT_AREA] >= smallest
    keep[1 + int(np.argmax(statistics[1:, cv2.CC_STAT_AREA]))] = True
    keep[0] = False
    return keep[labels]
