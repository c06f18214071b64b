"""Lines of ink."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .channels import over_channels

__all__ = ["ink_lines"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Lines that are wider than this disc are areas [px].
_DISC = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (11, 11))
# A line is darker than what is beside it by this, or by so many times the noise.
_DARKER = 0.1
_DEVIATIONS = 6.0
# Far beyond every colour: unknown pixels must win neither a maximum nor a minimum.
_NO_COLOUR = np.float32(9)


def ink_lines(picture: FloatImage, known: Mask, noise: float) -> tuple[FloatImage, Mask]:
    """By how much a known line is darker than what is on both its sides, and where lines are, both shape [h, w].

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        known: shape [h, w].
        noise: deviation of what is flat, in 0 to 1.
    """
    lightness = over_channels(picture) / np.float32(3)
    widened = cv2.dilate(np.where(known, lightness, -_NO_COLOUR), _DISC)
    closed = cv2.erode(np.where(widened > -_NO_COLOUR, widened, _NO_COLOUR), _DISC)
    depth = np.where(known, closed - lightness, 0).astype(np.float32)
    return depth, depth > max(_DARKER, _DEVIATIONS * noise)
