"""Colours times their alpha: the form in which pictures with transparency may be mixed and resized."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from .pixels import as_dtype, as_float

__all__ = ["premultiplied", "resized", "straight"]

FloatImage = NDArray[np.float32]

# A smaller alpha is none in 8 bits, and its colours are those of rounding errors.
_NO_ALPHA = np.float32(1e-4)


def premultiplied(image: NDArray[Any]) -> FloatImage:
    """Straight RGBA, uint8 or float32 in 0 to 1, with its colours times alpha: float32, shape [h, w, 4]."""
    planes = as_float(image)
    planes[..., :3] *= planes[..., 3:]
    return planes


def straight(image: FloatImage) -> FloatImage:
    """The reverse: colours over alpha, in 0 to 1; black where there is no alpha. Shape [h, w, 4]."""
    # Where resampling went beyond 1, colours went along: their ratio is right.
    alpha = image[..., 3:]
    colours = np.where(alpha > _NO_ALPHA, image[..., :3] / np.maximum(alpha, _NO_ALPHA), np.float32(0))
    return np.clip(np.concatenate([colours, alpha], axis=2), 0, 1)


def resized(picture: NDArray[Any], width: int, height: int, *, nearest: bool = False) -> NDArray[Any]:
    """A picture at another size, its dtype and channels kept.

    Args:
        picture: grey, RGB or straight RGBA, uint8 or float32 in 0 to 1, shape [h, w], [h, w, 3] or [h, w, 4].
        width: of the result [px].
        height: of the result [px].
        nearest: take pixels as they are, as pixel art needs it, instead of mixing them.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.pictures import resized
        >>> resized(np.zeros((4, 6, 3), np.uint8), 12, 8).shape
        (8, 12, 3)
    """
    if nearest:
        row, column = (
            (2 * np.arange(count) + 1) * there // (2 * count)
            for count, there in ((height, picture.shape[0]), (width, picture.shape[1]))
        )
        return picture[row[:, None], column]
    method = cv2.INTER_CUBIC if width > picture.shape[1] else cv2.INTER_AREA
    if picture.ndim == 3 and picture.shape[2] == 4:
        return as_dtype(
            straight(cv2.resize(premultiplied(picture), (width, height), interpolation=method)), picture.dtype
        )
    return cv2.resize(picture, (width, height), interpolation=method)
