"""For every pixel the nearest one of some."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["nearest_pixels"]


def nearest_pixels(where: NDArray[np.bool_]) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """How far each pixel is from the nearest true one, and which one that is, to within a few per cent.

    SciPy's exact transform takes three times as long (measured at 1280 x 720 px).

    Args:
        where: some must be true, shape [h, w].

    Returns:
        Distance [px] and number, counted row by row, each of shape [h, w]; a true pixel is its own nearest.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.pictures import nearest_pixels
        >>> nearest_pixels(np.array([[True, False, False, True]]))[1].tolist()
        [[0, 0, 3, 3]]
    """
    distance, labels = cv2.distanceTransformWithLabels(
        (~where).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    numbers = np.zeros(int(labels.max()) + 1, dtype=np.int32)
    numbers[labels[where]] = np.flatnonzero(where)
    return np.asarray(distance, dtype=np.float32), numbers[labels]
