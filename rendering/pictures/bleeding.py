"""Colours carried on into places where nothing is known of them: behind transparency, say.

Encoders mix the colours of neighbours whatever their alpha. What is hidden under alpha 0 then shows as a rim, unless it
is of the colours beside.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .pixels import as_float

__all__ = ["bled", "carried_on"]

FloatImage = NDArray[np.float32]

# A smaller weight is none: what was divided by it would be rounding.
_LEAST = np.float32(1e-6)


def carried_on(colours: FloatImage, weight: FloatImage) -> FloatImage:
    """Known colours as they are, and everywhere else a smooth continuation of the nearest ones.

    Weighted means at ever coarser scales fill what finer ones leave open ("push-pull": Gortler et al., "The Lumigraph",
    1996).

    Args:
        colours: shape [h, w, c].
        weight: how far each pixel is known, 0 to 1, shape [h, w]; one of weight 0 gives nothing.

    Returns:
        Shape [h, w, c]; 0 where nothing is known at all.
    """
    return _filled(np.where(weight[..., None] > 0, colours, np.float32(0)), weight)


def _filled(colours: FloatImage, weight: FloatImage) -> FloatImage:
    height, width = weight.shape
    if max(height, width) == 1:
        return colours
    size = (width + 1) // 2, (height + 1) // 2
    mean = cv2.resize(weight, size, interpolation=cv2.INTER_AREA)
    total = cv2.resize(colours * weight[..., None], size, interpolation=cv2.INTER_AREA).reshape(*mean.shape, -1)
    coarse = _filled(total / np.maximum(mean, _LEAST)[..., None], (mean > 0).astype(np.float32))
    guess = cv2.resize(coarse, (width, height), interpolation=cv2.INTER_LINEAR).reshape(height, width, -1)
    return np.where(weight[..., None] > 0, colours, guess)


def bled(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A picture whose visible colours go on under its alpha 0; what can be seen stays as it is.

    Args:
        picture: straight RGBA, shape [h, w, 4].
    """
    alpha = picture[..., 3]
    if alpha.min() > 0:
        return picture
    colours = carried_on(picture[..., :3].astype(np.float32), as_float(alpha))
    return np.dstack([np.rint(colours).astype(np.uint8), alpha])
