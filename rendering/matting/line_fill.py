"""Alpha between a part and its drawn outline, where the outline was found beside the mask."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import window_around
from .mask_edges import CROSS, FAINT, SOLID, SQUARE, grown

__all__ = ["filled_behind_lines"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Ways from outside in to what lies behind an outline are no longer than this [px].
_WAY = 24


def filled_behind_lines(alpha: FloatImage, mask: FloatImage, support: Mask) -> FloatImage:
    """Alpha raised where an outline found outside of a mask divides a pixel from what is around the part.

    Between the part's colour and the line's own, colours pass through others that may be like the background's, and a
    share measured there is too small. What shows nothing of the background anywhere on the way from outside cannot
    show any of it further in, so that alpha is at least the greatest on that way; but for gaps of three pixels and
    more, through which the background may really be seen.

    Args:
        alpha: in 0 to 1, shape [h, w].
        mask: soft mask in 0 to 1, shape [h, w].
        support: where the part is, outlines included; shape [h, w].

    Returns:
        Alpha in 0 to 1, shape [h, w].
    """
    line = support & (mask <= FAINT)
    asked = line | (support & (mask < SOLID) & grown(line, SQUARE))
    if not asked.any() or support.all():
        return alpha
    window = window_around(asked, margin=2)
    inside, own = support[window], alpha[window]
    way = np.where(inside, np.float32(1), own)
    for _ in range(_WAY):
        further = np.maximum(own, cv2.erode(way, CROSS))
        if np.array_equal(further, way):
            break
        way = further
    least = np.minimum(way, cv2.morphologyEx(own, cv2.MORPH_CLOSE, SQUARE))
    filled = alpha.copy()
    filled[window] = np.where(asked[window], np.maximum(own, least), own)
    return filled
