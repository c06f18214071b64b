"""Drawn lines: where they are, and whether they are the outline of a part."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .mask_edges import CROSS, SQUARE, grown, mean_near

__all__ = [
    "LUMINANCE",
    "OUTLINED",
    "OUTLINE_REACH",
    "TOLERANCE",
    "disc",
    "followed",
    "lines",
    "outline_ink",
    "with_ink",
]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

LUMINANCE = np.array([0.299, 0.587, 0.114], dtype=np.float32)

TOLERANCE = 0.055
"""Drawn lines are darker, or lighter, than what is on either side of them by this."""

OUTLINED = 0.45
"""Lines are an outline where they follow this share of an edge."""

OUTLINE_REACH = 5
"""An outline lies no further outside of a mask than this [px]."""

WIDEST_LINE = 5
"""Drawn lines are no wider than this [px]."""


def lines(lightness: FloatImage) -> Mask:
    """Lines darker than what is on either side, shape [h, w]."""
    return cv2.morphologyEx(lightness, cv2.MORPH_CLOSE, disc(WIDEST_LINE // 2)) - lightness > TOLERANCE


def followed(line: Mask, shape: Mask) -> float:
    """The share of a part's edge that lines run along."""
    edge = shape & grown(~shape, CROSS)
    return int((edge & grown(line, SQUARE)).sum()) / max(1, int(edge.sum()))


def outline_ink(image: FloatImage, shape: Mask) -> Mask:
    """The lines, dark or light, of which the part's outline is one; none if it has no outline.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3], or with further channels.
        shape: the part as far as it is known, shape [h, w].
    """
    light = image[..., :3] @ LUMINANCE
    ink = max((lines(light), lines(1 - light)), key=lambda each: followed(each, shape))
    return ink if followed(ink, shape) > OUTLINED else np.zeros_like(shape)


def with_ink(image: FloatImage, shape: Mask) -> Mask:
    """A shape and the ink that runs along its edge, just outside.

    Where a shape ends at a shaded rim within its outline, the outline stays behind in a narrow gap between two dark
    things, in which nothing lighter tells it apart. It is known by its being ink on more of the edge's length than
    there is ink farther off, and by there being nothing between it and the part; lines that only end at the part or
    pass by stay.
    """
    ink = outline_ink(image, shape)
    distance = cv2.distanceTransform((~shape).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    beyond = (distance > OUTLINE_REACH) & (distance <= 2 * OUTLINE_REACH)
    share = ink.astype(np.float32)
    least = np.maximum(mean_near(share, beyond)[0], np.float32(OUTLINED))
    whole = shape
    for step in range(OUTLINE_REACH):
        ring = (distance > step) & (distance <= step + 1)
        whole = whole | (ring & ink & (mean_near(share, ring)[0] > least) & grown(whole, SQUARE))
    return whole


def disc(radius: int) -> NDArray[np.uint8]:
    """A round neighbourhood."""
    return np.asarray(cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1,) * 2), dtype=np.uint8)
