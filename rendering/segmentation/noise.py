"""Noise, grain and brush texture: how strong they are, and the picture without them; and how sharp its edges are."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["LEAST_NOISE", "noise_of", "sharpness_of", "without_noise"]

Lab = NDArray[np.uint8]
Mask = NDArray[np.bool_]

# A median absolute deviation times this is the standard deviation of a normal distribution.
_NORMAL = 1.4826
LEAST_NOISE = 2.0
"""Clean art has this much from its soft edges and from JPEG."""
# tests/benchmarks/thresholds.py measures half and twice of _REACH and _CLEAR on painted parts: they decide single cuts.
_REACH = 9  # window of the filters, over which a soft edge fits [px]
_CLEAR = 40  # lightness by which the two sides of a clear edge differ


def noise_of(lab: Lab, where: Mask | None = None, *, size: int = 3) -> float:
    """Standard deviation of what changes from pixel to pixel over most of a picture or of a part of it [8-bit steps].

    Flat art gives 0, however many lines it holds, as long as they cover the lesser part of it.

    Args:
        lab: shape [h, w, 3].
        size: twice that of the coarsest texture which counts, odd [px].
        where: the part, shape [h, w]; the whole picture where it is empty or left out.
    """
    rest = cv2.absdiff(lab, cv2.medianBlur(lab, size)).max(axis=2)
    return float(_NORMAL * np.median(rest[where] if where is not None and where.any() else rest))


def without_noise(lab: Lab, noise: float) -> Lab:
    """The picture with noise averaged away, and its edges kept; with hardly any it stays as it is.

    Args:
        lab: shape [h, w, 3].
        noise: of ``noise_of`` [8-bit steps].
    """
    if noise < LEAST_NOISE:
        return lab
    smooth = cv2.bilateralFilter(lab, _REACH, 4 * noise, _REACH / 3)
    return cv2.bilateralFilter(smooth, _REACH, 2 * noise, _REACH / 3)


def sharpness_of(lab: Lab) -> float:
    """The share of a clear edge's contrast between two pixels: 0.7 and more on clean art, under 0.3 with an airbrush.

    Args:
        lab: shape [h, w, 3].

    Returns:
        The median over the pixels near clear edges, 1 where there are none.
    """
    light = np.ascontiguousarray(lab[..., 0])
    steps = np.zeros_like(light)
    if light.shape[1] > 1:  # OpenCV gives nothing back for nothing
        steps[:, 1:] = cv2.absdiff(light[:, 1:], light[:, :-1])
    if len(light) > 1:
        steps[1:] = np.maximum(steps[1:], cv2.absdiff(light[1:], light[:-1]))
    window = np.ones((_REACH, _REACH), np.uint8)
    contrast = cv2.subtract(cv2.dilate(light, window), cv2.erode(light, window))
    clear = contrast >= _CLEAR
    steps = cv2.dilate(steps, window)
    return float(np.median(steps[clear] / contrast[clear])) if clear.any() else 1.0
