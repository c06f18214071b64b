"""The outline of a part where what is behind is as dark as its ink, or as varied: the ink's colour tells it there."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import nearest_pixels
from .drawn_lines import LUMINANCE, TOLERANCE, outline_ink
from .mask_edges import LEAST_CONTRAST, SQUARE, mean_near

__all__ = ["coloured_outline"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]


def coloured_outline(image: FloatImage, shape: Mask, *, reach: int, as_dark: bool = True) -> Mask:
    """What runs along a part and is rather of its outline's colour than of the colour beyond.

    A line as wide as the reach is no outline, but something else of that colour.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3], or with further channels.
        shape: the part, shape [h, w].
        reach: how far an outline may lie outside [px].
        as_dark: only where what lies beyond is as dark as the ink.

    Returns:
        Pixels outside of the part, shape [h, w]; none if the part has no outline.
    """
    image = image[..., :3]
    distance = cv2.distanceTransform((~shape).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    beyond = _near(image, (distance > reach) & (distance <= 2 * reach))
    line = outline_ink(image, shape) & (distance > 0) & (distance <= reach)
    # A line's own colour is where it differs most from what is behind: its rim is mixed.
    strength = np.where(line, np.linalg.norm(image - beyond, axis=2), 0).astype(np.float32)
    ink = _nearest(image, line & (strength >= cv2.dilate(strength, SQUARE)))
    telling = (np.linalg.norm(ink - beyond, axis=2) > LEAST_CONTRAST) & _nearer(image, ink, beyond)
    if as_dark:
        telling &= (beyond - ink) @ LUMINANCE < TOLERANCE
    rings = [(distance > step) & (distance <= step + 1) for step in range(reach)]
    means = [_near(image, ring) for ring in rings]
    telling &= ~_nearer(means[-1], ink, beyond)
    return np.any(
        [ring & telling & _nearer(mean, ink, beyond) for ring, mean in zip(rings, means, strict=True)], axis=0
    )


def _nearest(image: FloatImage, where: Mask) -> FloatImage:
    """For each pixel the mean colour around the nearest of those in ``where``, shape [h, w, 3]."""
    if not where.any():
        return image
    return _near(image, where).reshape(-1, 3)[nearest_pixels(where)[1]]


def _near(image: FloatImage, where: Mask) -> FloatImage:
    """Mean colours of the pixels in ``where`` nearby, shape [h, w, 3]."""
    return np.dstack([mean_near(channel, where)[0] for channel in cv2.split(image)])


def _nearer(colour: FloatImage, one: FloatImage, other: FloatImage) -> Mask:
    away, further = colour - one, colour - other
    return np.asarray((away * away).sum(axis=2) < (further * further).sum(axis=2))
