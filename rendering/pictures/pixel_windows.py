"""Windows of a picture."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["window_around"]

Mask = NDArray[np.bool_]


def window_around(mask: Mask, *, margin: int) -> tuple[slice, slice]:
    """Rows and columns of the true pixels and of ``margin`` more on every side, within the picture."""
    left, top, width, height = cv2.boundingRect(mask.astype(np.uint8))
    return (
        slice(max(0, top - margin), min(mask.shape[0], top + height + margin)),
        slice(max(0, left - margin), min(mask.shape[1], left + width + margin)),
    )
