"""A texture with what lies half-way between its pixels, so that it is read at any place sharply and without overshoot.

Source of the filter: ITU-T H.265, 8.5.3.3.3, the luma sample interpolation at half-pixel places.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["with_half_pixels"]

FloatImage = NDArray[np.float32]

_HALF_WAY = np.array([-1, 4, -11, 40, 40, -11, 4, -1], dtype=np.float32) / 64
_AROUND = 4


def with_half_pixels(texture: FloatImage) -> tuple[FloatImage, int]:
    """A texture at twice its resolution, in which its own pixels are every other one, unchanged.

    Args:
        texture: premultiplied RGBA in 0 to 1, shape [h, w, 4]; nothing is beyond it.

    Returns:
        The finer texture, shape [2 h + 16, 2 w + 16, 4], with no more light than alpha; and the pixels n of a border
        around it: pixel [r, c] is at [2 (r + n), 2 (c + n)] of it.
    """
    around = cv2.copyMakeBorder(texture, *(_AROUND,) * 4, cv2.BORDER_CONSTANT, value=0)
    height, width = around.shape[:2]
    fine = np.empty((2 * height, 2 * width, 4), dtype=np.float32)
    fine[::2, ::2] = around
    fine[::2, 1::2] = cv2.filter2D(around, -1, _HALF_WAY[None], anchor=(3, 0), borderType=cv2.BORDER_CONSTANT)
    fine[1::2] = cv2.filter2D(
        np.ascontiguousarray(fine[::2]), -1, _HALF_WAY[:, None], anchor=(0, 3), borderType=cv2.BORDER_CONSTANT
    )
    alpha = np.clip(fine[..., 3], 0, 1)
    fine[..., 3] = alpha
    for channel in range(3):
        fine[..., channel] = cv2.min(cv2.max(fine[..., channel], 0), alpha)
    return fine, _AROUND
