"""Dense optical flow between two pictures."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["LEAST_FLOW_SIDE", "optical_flow"]

LEAST_FLOW_SIDE = 16
"""Shortest side of pictures between which flow is looked for [px]: on smaller ones OpenCV's search ends the process."""


def optical_flow(first: NDArray[np.uint8], second: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Flow by dense inverse search (Kroeger et al., "Fast optical flow using dense inverse search", 2016).

    Args:
        first, second: grey pictures of one size, shape [h, w].

    Returns:
        Displacement from the first to the second [px], shape [h, w, 2]; 0 between pictures that are too small.
    """
    if min(first.shape) < LEAST_FLOW_SIDE:
        return np.zeros((*first.shape, 2), dtype=np.float32)
    search = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    return np.asarray(search.calc(np.ascontiguousarray(first), np.ascontiguousarray(second), None), dtype=np.float32)
