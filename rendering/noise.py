"""Noise, grain and brush texture: how strong they are, and the picture without them."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["noise_of", "without_noise"]

Lab = NDArray[np.uint8]

# A median absolute deviation times this is the standard deviation of a normal distribution.
_NORMAL = 1.4826
_LEAST = 1.0
_REACH = 9


def noise_of(lab: Lab) -> float:
    """Standard deviation of what changes from pixel to pixel over most of the picture [8-bit steps].

    Flat art gives 0, however many lines it holds: they cover the lesser part of it.

    Args:
        lab: shape [h, w, 3].
    """
    rest = cv2.absdiff(lab, cv2.medianBlur(lab, 3))
    return float(_NORMAL * np.median(rest.max(axis=2)))


def without_noise(lab: Lab) -> Lab:
    """The picture with its own noise averaged away, and its edges kept; clean pictures as they are.

    Args:
        lab: shape [h, w, 3].
    """
    noise = noise_of(lab)
    if noise < _LEAST:
        return lab
    smooth = cv2.bilateralFilter(lab, _REACH, 4 * noise, _REACH / 3)
    return cv2.bilateralFilter(smooth, _REACH, 2 * noise, _REACH / 3)
