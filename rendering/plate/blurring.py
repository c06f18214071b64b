"""Pictures blurred more in one place than in another."""

from __future__ import annotations

from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["blurred"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Blurs that double from each to the next; between them is mixed. The narrowest is less than a pixel's own [px].
_WIDTHS = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)


def blurred(picture: FloatImage, sigma: FloatImage, shown: Mask) -> FloatImage:
    """Blur a picture by a Gaussian that may be of another width everywhere.

    Args:
        picture: shape [h, w, 3].
        sigma: of the Gaussian [px], shape [h, w]; below half a pixel nothing is blurred, above 32 no more.
        shown: what takes part, shape [h, w]; elsewhere the picture stays as it is.

    Returns:
        The picture, shape [h, w, 3].
    """
    weighted = np.dstack([picture * shown[..., None], shown.astype(np.float32)])
    result, narrower = picture, weighted
    for below, width in pairwise(_WIDTHS):
        share = np.clip(np.log2(np.maximum(sigma, np.float32(1e-3)) / np.float32(below)), 0, 1)
        if not share.any():
            break
        step = float(np.sqrt(width**2 - (below**2 if narrower is not weighted else 0)))
        narrower = _gaussian(narrower, step)
        mean = narrower[..., :3] / np.maximum(narrower[..., 3:], np.float32(1e-6))
        result = result + (share * shown)[..., None] * (mean - result)
    return result


def _gaussian(picture: FloatImage, sigma: float) -> FloatImage:
    """The same everywhere, wide ones at a part of the size."""
    scale = 1
    while sigma / scale >= 4:
        scale *= 2
    if scale == 1:
        return cv2.GaussianBlur(picture, (0, 0), sigma)
    size = -(-picture.shape[1] // scale), -(-picture.shape[0] // scale)
    small = cv2.GaussianBlur(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), (0, 0), sigma / scale)
    return cv2.resize(small, picture.shape[1::-1], interpolation=cv2.INTER_LINEAR)
