"""Sketches as the networks get them in training: blurred by a strength that is drawn anew for every sample.

The paper blurs sketches in training and in use, so that the network does not insist on lines which the simulation puts
a little wrong (paper, Method, "Sketch-Guided Rendering").
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["blurred", "drawn_blur"]


def drawn_blur(chance: np.random.Generator, least: float, most: float) -> float:
    """Strength of the blur, its standard deviation [px]: all from ``least`` to ``most`` alike likely."""
    return float(chance.uniform(least, most))


def blurred(sketches: NDArray[np.float32], sigma: float) -> NDArray[np.float32]:
    """Sketches under a Gaussian blur.

    Args:
        sketches: lines 1 on 0, shape [t, h, w].
        sigma: standard deviation [px]; 0 leaves them as they are.
    """
    if sigma <= 0:
        return sketches
    return np.stack([cv2.GaussianBlur(each, (0, 0), sigma, borderType=cv2.BORDER_REPLICATE) for each in sketches])
