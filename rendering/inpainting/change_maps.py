"""How much of each pixel may change, from what a motion has uncovered."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require

__all__ = ["change_map"]

FloatImage = NDArray[np.float32]


def change_map(
    uncovered: FloatImage, covered: FloatImage | None = None, *, grow: float = 4.0, soft_edge: float = 16.0
) -> FloatImage:
    """1 in the holes and close to them, falling smoothly to 0 within the soft edge.

    Args:
        uncovered: how much of each pixel moving parts have left, 0..1, shape [h, w].
        covered: what lies over the holes, such as parts that have moved, 0..1, shape [h, w]: the holes do not grow into
            it, only their soft edge reaches there.
        grow: how far holes reach beyond what was uncovered [px].
        soft_edge: width of the transition around them [px].

    Returns:
        0..1, shape [h, w].

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.inpainting import change_map
        >>> hole = np.zeros((9, 40), np.float32)
        >>> hole[:, :8] = 1
        >>> change_map(hole, grow=2, soft_edge=8)[4, [4, 9, 13, 30]].tolist()
        [1.0, 1.0, 0.59326171875, 0.0]
    """
    require("grow", grow, 0 <= grow <= 1000, "0 to 1000 px")
    require("soft_edge", soft_edge, 0 <= soft_edge <= 1000, "0 to 1000 px")
    hole = uncovered > 0.5
    if grow and hole.any():
        grown = _distance_to(hole) <= grow
        hole |= grown if covered is None else grown & (covered < 0.5)
    if not hole.any():
        return np.zeros(hole.shape, dtype=np.float32)
    ramp = np.clip(1 - _distance_to(hole) / max(soft_edge, 1e-3), 0, 1)
    return np.asarray(ramp * ramp * (3 - 2 * ramp), dtype=np.float32)


def _distance_to(region: NDArray[np.bool_]) -> FloatImage:
    """Distance of each pixel from the border of a region, 0 inside [px]."""
    if region.all():
        return np.zeros(region.shape, dtype=np.float32)
    outside = cv2.distanceTransform((~region).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return np.asarray(np.maximum(outside - 0.5, 0), dtype=np.float32)
