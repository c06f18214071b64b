"""What masks are like: how soft their edges are, and what compressing or enlarging has left."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import nearest_pixels
from .mask_edges import CROSS, FAINT, grown

__all__ = ["NOISE", "MaskEdge", "edge_of", "from_edge", "in_blocks", "is_noisy", "step_of", "up_to_white"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

NOISE = 0.1
"""Noise around edges, as compression makes it, stays below this much."""

_HALF = 0.5
# What differs less from white is white: even so little of the part's black missing would blacken what is behind it.
_WHITE = 1 - 0.5 / 255
# Noise stays below this share of the edge's pixels.
_NOISY = 0.1
# Share of soft pixels in uniform blocks from which on a mask has been enlarged without smoothing.
_BLOCKS = 0.25
# An edge in steps has this many corners for each of its pixels, and hardly any nearer to each other than a step.
_LEAST_CORNERS = 12
_STEPS = 0.01
_CROWDED = 0.1
_HIGHEST = 16


@dataclass(frozen=True, eq=False)
class MaskEdge:
    """The edge of a mask.

    Attributes:
        inside: the part, shape [h, w].
        line: its outermost pixels, shape [h, w].
        width: of the transition at the nearest place of the edge [px], shape [h, w].
    """

    inside: Mask
    line: Mask
    width: FloatImage

    def median_width(self) -> float:
        """Half of the edge is softer than this [px]."""
        return float(np.median(self.width[self.line]))


def edge_of(mask: FloatImage) -> MaskEdge:
    """The edge of a mask, shape [h, w]."""
    inside = mask > _HALF
    line = inside & grown(~inside, CROSS)
    soft = ((mask > 0.05) & (mask < 0.95)).astype(np.float32)
    # So many soft pixels there are for each of the edge.
    there = cv2.GaussianBlur(line.astype(np.float32), (0, 0), 5.0)
    local = cv2.GaussianBlur(soft, (0, 0), 5.0) / np.maximum(there, np.float32(1e-3))
    return MaskEdge(inside, line, np.where(line, local, np.float32(0)).ravel()[nearest_pixels(line)[1]])


def up_to_white(mask: FloatImage) -> FloatImage:
    """A mask that nowhere becomes white, scaled up to white."""
    highest = float(mask.max(initial=0))
    if highest <= FAINT:
        return mask
    bright, brightest = int(np.count_nonzero(mask > _HALF * highest)), int(np.count_nonzero(mask == highest))
    if brightest >= bright - int(0.9 * (bright - 1)):  # as the percentile would say, which takes much longer
        white = highest
    else:
        white = float(np.percentile(mask[mask > _HALF * highest], 90))
    mask = mask / np.float32(white) if white < 0.98 else mask
    return np.where(mask > _WHITE, np.float32(1), mask)


def is_noisy(mask: FloatImage) -> bool:
    """Whether there are faint specks near the edge, as compression leaves them."""
    inside = mask > _HALF
    faint = (mask > FAINT) & (mask < NOISE) & (from_edge(inside) > 2)
    return int(faint.sum()) > _NOISY * int((inside & grown(~inside, CROSS)).sum())


def in_blocks(mask: FloatImage) -> bool:
    """Whether the soft pixels come in blocks of one value."""
    corners = np.stack([mask[:-1, :-1], mask[1:, :-1], mask[:-1, 1:], mask[1:, 1:]])
    soft = (corners > 0.05) & (corners < 0.95)
    alike = soft.all(axis=0) & (np.ptp(corners, axis=0) < 1e-3)
    count = int(soft[0].sum())
    return count > 0 and 4 * int(alike.sum()) > _BLOCKS * count


def step_of(mask: FloatImage) -> int:
    """The height of the steps that the edge goes in, as enlarging without smoothing leaves them [px].

    A drawn edge that is neither upright nor level has steps of one pixel somewhere, whose corners are neighbours.

    Returns:
        1 for such an edge, and for one that hardly has corners.
    """
    inside = (mask > _HALF).astype(np.uint8)
    corners = (inside[:-1, :-1] + inside[1:, :-1] + inside[:-1, 1:] + inside[1:, 1:]) & 1
    count, line = int(corners.sum()), int(cv2.morphologyEx(inside, cv2.MORPH_GRADIENT, CROSS).sum())
    if count < max(_LEAST_CORNERS, _STEPS * line):
        return 1
    for step in range(1, _HIGHEST + 1):
        near = cv2.boxFilter(corners, cv2.CV_32F, (2 * step + 1,) * 2, normalize=False)
        if int(((corners > 0) & (near > 1)).sum()) > _CROWDED * count:
            return step
    return 1


def from_edge(shape: Mask) -> FloatImage:
    """From the edge of a shape, on either side [px], shape [h, w]."""
    sides = [cv2.distanceTransform(side.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5) for side in (shape, ~shape)]
    return np.asarray(np.maximum(*sides), dtype=np.float32)
