"""Means over so wide surroundings that a quarter of the resolution is enough."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["wide_mean"]

FloatImage = NDArray[np.float32]

_SHRUNK = 4


def wide_mean(plane: FloatImage, sigma: float) -> FloatImage:
    """The mean around each pixel, weighted by a Gaussian of a width of 8 pixels or more [px], shape [h, w]."""
    height, width = plane.shape
    size = max(1, round(width / _SHRUNK)), max(1, round(height / _SHRUNK))
    small = cv2.resize(plane, size, interpolation=cv2.INTER_AREA)
    small = cv2.GaussianBlur(small, (0, 0), sigmaX=sigma * size[0] / width, sigmaY=sigma * size[1] / height)
    return np.asarray(cv2.resize(small, (width, height), interpolation=cv2.INTER_LINEAR), dtype=np.float32)
