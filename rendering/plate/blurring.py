"""Pictures blurred more in one place than in another."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import window_around

__all__ = ["blurred"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Blurs that double from each to the next; between them is mixed. The narrowest is less than a pixel's own [px].
_WIDTHS = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)
# A Gaussian ends so many deviations from its middle, and may be as narrow as this where it is sampled [px].
_SEEN = 3
_FINEST = 1.5


def blurred(picture: FloatImage, sigma: FloatImage, shown: Mask) -> FloatImage:
    """Blur a picture by a Gaussian that may be of another width everywhere.

    Args:
        picture: shape [h, w, 3].
        sigma: of the Gaussian [px], shape [h, w]; below half a pixel nothing is blurred, above 32 no more.
        shown: what takes part, shape [h, w]; elsewhere the picture stays as it is.

    Returns:
        The picture, shape [h, w, 3].
    """
    if not (sigma > _WIDTHS[0]).any():
        return picture
    window = window_around(sigma > _WIDTHS[0], margin=int(_SEEN * min(float(sigma.max()), _WIDTHS[-1])) + 1)
    sharp, part = picture[window], shown[window]
    narrower = np.dstack([sharp * part[..., None], part.astype(np.float32)])
    wide = np.log2(np.maximum(sigma[window], np.float32(1e-3)) / np.float32(_WIDTHS[0]))
    result, before = picture.copy(), 0.0
    inner = result[window]
    for number, width in enumerate(_WIDTHS[1:]):
        at = np.nonzero(part & (wide > number))
        if not len(at[0]):
            break
        narrower, before = _gaussian(narrower, float(np.sqrt(width**2 - before**2))), width
        found = narrower[at]
        share = np.minimum(wide[at] - number, 1)[:, None]
        inner[at] += share * (found[:, :3] / np.maximum(found[:, 3:], np.float32(1e-6)) - inner[at])
    return result


def _gaussian(picture: FloatImage, sigma: float) -> FloatImage:
    """The same everywhere, wide ones at a part of the size."""
    scale = 1
    while sigma / scale >= 2 * _FINEST:
        scale *= 2
    if scale == 1:
        return cv2.GaussianBlur(picture, (0, 0), sigma)
    size = -(-picture.shape[1] // scale), -(-picture.shape[0] // scale)
    small = cv2.GaussianBlur(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), (0, 0), sigma / scale)
    return cv2.resize(small, picture.shape[1::-1], interpolation=cv2.INTER_LINEAR)
