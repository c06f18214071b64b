"""What a blurred mask still has of strands that blurring has left less than half of."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .drawn_lines import OUTLINE_REACH, disc
from .mask_edges import SQUARE, grown

__all__ = ["traced_lines", "traced_strands"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Between nothing and all that a strand would have left.
_HALF = 0.5


def traced_strands(strands: Mask, shape: Mask, mask: FloatImage, *, sigma: float, lost: int) -> Mask:
    """The strands of which a blurred mask has a trace.

    Blurring leaves faint tones of what is narrow. A mask has more of them where such a strand was than its own
    bright part leaves there when that is blurred as much: for the strand at least half of what it would add itself.

    Args:
        strands: what may have been lost, in pieces that do not touch, shape [h, w].
        shape: the part as far as it is known, shape [h, w].
        mask: the mask as it was given, in 0 to 1, shape [h, w].
        sigma: of the blur [px].
        lost: how much had been taken off on either side before the mask was blurred [px].

    Returns:
        The pieces that are traced, shape [h, w].
    """
    given = mask > _HALF
    left = strands
    if lost:
        drawn = grown(strands, SQUARE)
        left = (cv2.erode((shape | drawn).astype(np.uint8), disc(lost)) > 0) & drawn & ~given
    of_strand, more = _blurred(left, sigma), mask - _blurred(given, sigma)
    count, labels = cv2.connectedComponents(strands.astype(np.uint8), connectivity=8)
    piece = labels[strands]
    found, whole = (np.bincount(piece, (of_strand * each)[strands], minlength=count) for each in (more, of_strand))
    traced = (whole > 0) & (found > _HALF * whole)
    return np.asarray(strands & traced[labels])


def traced_lines(line: Mask, shape: Mask, mask: FloatImage, told: Mask, *, sigma: float) -> Mask:
    """The stretches of lines leading away from a part, as tips of strands do, of which a blurred mask has a trace.

    What stays near the part is an outline that runs along it.

    Args:
        line: thin lines, shape [h, w].
        shape: the part as far as it is known, shape [h, w].
        mask: the mask as it was given, in 0 to 1, shape [h, w].
        told: what explains faint tones of the mask already, shape [h, w].
        sigma: of the blur [px].

    Returns:
        Pixels of lines beyond ``shape``, shape [h, w].
    """
    beyond = line & ~shape
    of_line, more = _blurred(beyond, sigma), mask - _blurred(told, sigma)
    found, whole = (cv2.GaussianBlur(of_line * each, (0, 0), sigma) for each in (more, of_line))
    traced = beyond & (found > _HALF * whole)
    count, labels = cv2.connectedComponents(traced.astype(np.uint8), connectivity=8)
    held, leads_away = np.zeros((2, count), dtype=bool)
    held[labels[traced & grown(shape, SQUARE)]] = True
    leads_away[labels[traced & ~grown(shape, disc(OUTLINE_REACH))]] = True
    return np.asarray(traced & (held & leads_away)[labels])


def _blurred(shape: Mask, sigma: float) -> FloatImage:
    return np.asarray(cv2.GaussianBlur(shape.astype(np.float32), (0, 0), sigma), dtype=np.float32)
