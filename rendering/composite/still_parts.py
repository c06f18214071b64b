"""Keeping the illustration's own pixels wherever nothing moves, around frames that a video model has drawn."""

from __future__ import annotations

from collections.abc import Iterable
from functools import reduce

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require

__all__ = ["keep_still_parts", "moving_region"]

FloatImage = NDArray[np.float32]


def moving_region(alphas: Iterable[FloatImage], *, soft_edge: float) -> FloatImage:
    """Where a clip moves: one region for all frames, so that its border does not flicker.

    Args:
        alphas: how much moving bodies cover of each pixel, 0..1, one of shape [h, w] for each frame.
        soft_edge: width of the transition outside what they cover [px].

    Returns:
        1 wherever a body is in any frame, falling to 0 within the soft edge, shape [h, w].
    """
    require("soft_edge", soft_edge, soft_edge >= 0, "0 px or more")
    covered = reduce(np.maximum, alphas)
    outside = (covered < 0.5).astype(np.uint8)
    if not outside.any():
        return np.ones_like(covered)
    distance = cv2.distanceTransform(outside, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) - 0.5
    ramp = 1 - np.clip(distance / max(soft_edge, 1e-3), 0, 1)
    return np.maximum(ramp * ramp * (3 - 2 * ramp), covered).astype(np.float32)


def keep_still_parts(frame: FloatImage, image: FloatImage, region: FloatImage) -> FloatImage:
    """The frame inside the region, the illustration outside.

    Args:
        frame: as drawn, shape [h, w, 3].
        image: the illustration, shape [h, w, 3].
        region: 0..1, from ``moving_region``, shape [h, w].
    """
    share = region[..., None]
    return share * frame + (1 - share) * image
