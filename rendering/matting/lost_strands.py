"""Strands that a mask has lost altogether, because it was made smaller, or blurred wider, than they are wide.

A mask that has been shrunk still has the part's body, but nothing of strands narrower than what was taken off on
either side. In a drawing they can be found again: a strand has a colour that goes on from the part's, and the same
drawn outline along it. What is as wide as the part was before shrinking would have left something in the mask, so that
it is something else: the part's neighbour, or what somebody has cut off on purpose.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .drawn_lines import LUMINANCE, OUTLINED, TOLERANCE, WIDEST_LINE, disc, followed, lines, outline_ink
from .edge_search import explained
from .like_regions import like_regions
from .mask_edges import CROSS, SQUARE, grown, mean_near
from .strand_traces import traced_lines, traced_strands

__all__ = ["lost_lines", "lost_strands", "taken_off_of"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

_HALF = 0.5
# Lines follow more of a strand's edge than of another, as nothing else speaks for it.
_ENCLOSED = 0.6
# Colours of neighbouring pixels that differ by less go on in one another.
_STEP = 0.1
# A Gaussian blur leaves less than half of what is narrower than this on either side of its middle [sigmas].
_BLURRED_AWAY = 0.67
# So far a strand is followed at once [px].
_AHEAD = 40


def lost_strands(image: FloatImage, shape: Mask, mask: FloatImage, *, taken_off: int, sigma: float = 0) -> Mask:
    """What goes on from a part outside of it as its strands do.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3], or with further channels.
        shape: the part as far as it is known, shape [h, w].
        mask: the same as it was given, in 0 to 1, shape [h, w].
        taken_off: how much has been taken off the mask on either side, see :func:`taken_off_of` [px].
        sigma: how much the mask has been blurred [px].

    Returns:
        Strands beyond ``shape``, without their outlines, shape [h, w]; nothing if the mask has neither been shrunk nor
        blurred.
    """
    found, given = np.zeros_like(shape), mask > _HALF
    lost = taken_off + int(np.ceil(_BLURRED_AWAY * sigma))
    if lost:
        light = image[..., :3] @ LUMINANCE
        for lightness in (light, 1 - light):
            line = lines(lightness)
            if followed(line, shape) > OUTLINED:
                found |= _outlined(lightness, shape, _thin(_going_on(image, shape, line), shape, given, lost))
    return traced_strands(found, shape, mask, sigma=sigma, lost=taken_off) if sigma else found


def lost_lines(image: FloatImage, shape: Mask, mask: FloatImage, told: Mask, *, sigma: float) -> Mask:
    """Drawn lines that go on from a part, as the tips of strands do, and that a blurred mask has a trace of.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3], or with further channels.
        shape: the part as far as it is known, shape [h, w].
        mask: the same as it was given, in 0 to 1, shape [h, w].
        told: what of the shape explains the mask's faint tones already, shape [h, w].
        sigma: how much the mask has been blurred [px].

    Returns:
        Pixels of lines beyond ``shape``, shape [h, w]; nothing if the part has no outline, or the blur leaves less
        than half of the widest lines, whose traces cannot be told from those of their neighbours then.
    """
    if 2 * _BLURRED_AWAY * sigma > WIDEST_LINE:
        return np.zeros_like(shape)
    return traced_lines(outline_ink(image, shape), shape, mask, told, sigma=sigma)


def taken_off_of(shape: Mask, given: Mask) -> int:
    """How much smaller than the part its mask is at most of its edge [px]; 0 if it is not.

    Args:
        shape: the part without strands that the mask has lost, which are farther from it than that; shape [h, w].
        given: the mask, shape [h, w].
    """
    line = shape & grown(~shape, CROSS)
    beyond = line & ~given
    if not given.any() or 2 * int(beyond.sum()) <= int(line.sum()):
        return 0
    away = _distance_from(given)
    return int(np.ceil(np.median(away[beyond])))


def _going_on(image: FloatImage, shape: Mask, line: Mask) -> Mask:
    """What the part's colours go on in beyond its edge without a line between, and is of its colours."""
    core = (cv2.erode(shape.astype(np.uint8), SQUARE) > 0) & ~line
    asked = ~core & (_distance_from(shape) <= _AHEAD)
    if not (core.any() and asked.any()):
        return np.zeros_like(shape)
    # Ink is no colour of the core, so that it divides.
    own = core.copy()
    own[asked] = explained(image, asked, core) > _HALF
    own = cv2.morphologyEx(own.astype(np.uint8), cv2.MORPH_CLOSE, SQUARE) > 0
    return _reached(image, core, own) & ~shape


def _reached(image: FloatImage, core: Mask, free: Mask) -> Mask:
    """Free pixels that hang together with the core by steps between like colours."""
    labels = like_regions(image, free, step=_STEP)
    kept = np.zeros(int(labels.max()) + 1, dtype=bool)
    kept[labels[core & free]] = True
    kept[0] = False
    return kept[labels]


def _thin(strands: Mask, shape: Mask, given: Mask, lost: int) -> Mask:
    """Without what is so wide that something of it would be in the mask."""
    with_them, without = (cv2.erode(each.astype(np.uint8), disc(lost + 1)) > 0 for each in (shape | strands, shape))
    wide = with_them & ~without & ~grown(given, disc(lost))
    thin = strands & ~grown(wide, disc(lost + 2))
    return thin & grown(cv2.erode(thin.astype(np.uint8), np.ones((2, 2), np.uint8)) > 0, SQUARE)


def _outlined(lightness: FloatImage, shape: Mask, strands: Mask) -> Mask:
    """The strands that leave the part and have something darker along their edges."""
    darker = lightness < mean_near(lightness, strands, sigma=3.0)[0] - TOLERANCE
    beside = grown(shape, SQUARE)
    kept = np.zeros_like(strands)
    _, labels, boxes, _ = cv2.connectedComponentsWithStats(strands.astype(np.uint8), connectivity=8)
    for number, (left, top, width, height, _) in enumerate(boxes[1:], 1):
        box = slice(max(0, top - 1), top + height + 1), slice(max(0, left - 1), left + width + 1)
        strand = labels[box] == number
        edge = grown(strand, SQUARE) & ~strand & ~beside[box]
        if (strand & beside[box]).any() and int((darker[box] & edge).sum()) > _ENCLOSED * int(edge.sum()):
            kept[box] |= strand
    return kept


def _distance_from(shape: Mask) -> FloatImage:
    return np.asarray(cv2.distanceTransform((~shape).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5), dtype=np.float32)
