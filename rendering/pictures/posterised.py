"""Soft masks of few greys, which look like maps of labels."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["is_posterised"]

# Greys closer than this are noise, as JPEG makes it [8-bit levels].
_APART = 4
# Of all neighbours of two greys so many differ by one step; labels lie on black and beside any other label.
_ONE_STEP = 0.8
# More greys than this, each in the one before, are no accident.
_NESTED = 8
# With fewer, those between are nowhere farther from their edge than this share of the size of what is painted.
_NARROW = 0.08


def is_posterised(plane: NDArray[np.float32]) -> bool:
    """Whether a plane of few greys is a smooth transition in steps, as a soft mask of few greys is.

    Args:
        plane: 0 to 1, shape [h, w].
    """
    greys, step = np.unique(np.rint(plane * 255).astype(np.uint8), return_inverse=True)
    if len(greys) < 3 or np.diff(greys).min() < _APART:
        return False
    step = step.reshape(plane.shape).astype(np.int16)
    changes = np.concatenate([np.abs(np.diff(step, axis=axis)).ravel() for axis in (0, 1)])
    if np.count_nonzero(changes == 1) < _ONE_STEP * np.count_nonzero(changes):
        return False
    if len(greys) > _NESTED:
        return True
    between = [(step == number).astype(np.uint8) for number in range(1, len(greys) - 1)]
    widest = max(
        (float(cv2.distanceTransform(each, cv2.DIST_L2, cv2.DIST_MASK_5).max()) for each in between), default=0
    )
    return widest <= _NARROW * float(np.sqrt(np.count_nonzero(step)))
