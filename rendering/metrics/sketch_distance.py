"""How far the lines of two sketches are from each other."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require

__all__ = ["chamfer_distance"]

# A sketch is darker than this on a line, half-way from paper to ink.
_INK = 0.5


def chamfer_distance(first: NDArray[Any], second: NDArray[Any], *, limit: float = 20.0) -> float:
    """How far the lines of two sketches are from each other: mean distance to the nearest line, of both ways [px].

    Args:
        first: paper 1, lines 0, shape [h, w].
        second: of the same shape.
        limit: farther is counted as this far [px].

    Raises:
        InvalidInputError: the shapes differ.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.metrics import chamfer_distance
        >>> first, second = np.ones((2, 20, 20), np.float32)
        >>> first[:, 8], second[:, 10] = 0, 0
        >>> chamfer_distance(first, second)
        2.0
    """
    shapes = f"shapes {np.shape(first)} and {np.shape(second)}"
    require("sketches", shapes, np.ndim(first) == 2 and np.shape(first) == np.shape(second), "of one shape [h, w]")
    lines = [np.asarray(each) < _INK for each in (first, second)]
    if not (lines[0].any() and lines[1].any()):
        return float(limit) if lines[0].any() or lines[1].any() else 0.0
    away = [cv2.distanceTransform((~each).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE) for each in lines]
    means = [float(np.minimum(away[1 - k][lines[k]], limit).mean()) for k in (0, 1)]
    return sum(means) / 2
