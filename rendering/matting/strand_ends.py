"""The ends of strands, as thin as drawn lines, whose colours fade from the part's into something else."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .drawn_lines import LUMINANCE, OUTLINE_REACH, WIDEST_LINE, disc, lines
from .like_regions import like_regions
from .mask_edges import SQUARE, grown

__all__ = ["coloured_ends", "leading_away", "narrow_strands", "strand_ends"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Colours of neighbouring pixels that differ by less go on in one another.
_STEP = 0.2
# Directions are those of what lies this near to the strand's end [px], and differ by less than this cosine.
_NEAR, _ALONG = 12, 0.8
# A strand is this many times as long as it is wide.
_LONG = 3


def strand_ends(image: FloatImage, shape: Mask, strands: Mask) -> Mask:
    """Thin lines that go on from the strands of a part, in their direction, lead away and meet it nowhere else.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3], or with further channels.
        shape: the part as far as it is known, shape [h, w].
        strands: its strands, shape [h, w].

    Returns:
        Pixels of lines beyond ``shape``, shape [h, w].
    """
    light, found = image[..., :3] @ LUMINANCE, np.zeros_like(shape)
    narrow = narrow_strands(shape, strands)
    for lightness in (light, 1 - light):
        labels = like_regions(image, narrow | (lines(lightness) & ~shape), step=_STEP)
        goes_on = np.zeros(int(labels.max()) + 1, dtype=bool)
        goes_on[labels[narrow]] = True
        goes_on[0] = False
        found |= _continuing(goes_on[labels] & ~shape, strands, shape)
    return found


def coloured_ends(shape: Mask, coloured: Mask, given: Mask) -> Mask:
    """What goes on from the strands of a part in their colours, as they do, to where it ends.

    Along a thin strand what divides is never far, and the further from the part's body, the more it outweighs what the
    strand hangs together with.

    Args:
        shape: the part as far as it is known, shape [h, w].
        coloured: what is of the part's colours, shape [h, w].
        given: the mask; whoever left a strand out of it altogether may have meant to; shape [h, w].

    Returns:
        Pixels of strands beyond ``shape``, shape [h, w].
    """
    beyond = coloured & ~shape
    beyond = narrow_strands(beyond, beyond)
    if not beyond.any():
        return beyond
    strands = narrow_strands(shape | beyond, shape | beyond) & shape
    _, labels = cv2.connectedComponents(strands.astype(np.uint8), connectivity=8)
    # A strand is so narrow that what the mask has of it is near to all of it.
    near = grown(given, disc(WIDEST_LINE))
    whole, known = (np.bincount(labels.ravel(), each.ravel(), int(labels.max()) + 1) for each in (strands, near))
    return _continuing(beyond, strands & (2 * known > whole)[labels], shape)


def leading_away(shape: Mask, given: Mask) -> Mask:
    """What a shape has beyond a mask's ends and corners, as narrow as strands, going on as they do, shape [h, w]."""
    beyond = narrow_strands(shape, shape & ~given)
    return _continuing(beyond, given, given) if beyond.any() else beyond


def narrow_strands(shape: Mask, beyond: Mask) -> Mask:
    """What of ``beyond`` lies where a shape is narrow, in pieces much longer than they are wide, shape [h, w]."""
    # A line of single pixels counts as two pixels wide.
    _, labels, boxes, _ = cv2.connectedComponentsWithStats(beyond.astype(np.uint8), connectivity=8)
    large = boxes[:, cv2.CC_STAT_AREA] > _LONG * 2**2
    large[0] = False
    if not large.any():
        return np.zeros_like(shape)
    strands = beyond & ~(cv2.morphologyEx(shape.astype(np.uint8), cv2.MORPH_OPEN, disc(WIDEST_LINE)) > 0)
    _, labels, boxes, _ = cv2.connectedComponentsWithStats(strands.astype(np.uint8), connectivity=8)
    depth, width = cv2.distanceTransform(strands.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5), np.zeros(len(boxes))
    np.maximum.at(width, labels[strands], 2 * depth[strands])
    return np.asarray(strands & (boxes[:, cv2.CC_STAT_AREA] > _LONG * width**2)[labels])


def _continuing(line: Mask, strands: Mask, shape: Mask) -> Mask:
    """The pieces that leave a part behind, touch it in one place only, and go on there as the strand does."""
    kept, touched = np.zeros_like(line), grown(line, SQUARE) & shape
    far = ~grown(shape, disc(OUTLINE_REACH))
    _, labels, boxes, _ = cv2.connectedComponentsWithStats(line.astype(np.uint8), connectivity=8)
    for number, (left, top, width, height, _) in enumerate(boxes[1:], 1):
        box = slice(max(0, top - _NEAR), top + height + _NEAR), slice(max(0, left - _NEAR), left + width + _NEAR)
        piece = labels[box] == number
        place = touched[box] & grown(piece, SQUARE)
        if (piece & far[box]).any() and cv2.connectedComponents(place.astype(np.uint8), connectivity=8)[0] == 2:
            kept[box] |= piece & _straight_on(piece, place, strands[box])
    return kept


def _straight_on(piece: Mask, place: Mask, strands: Mask) -> bool:
    """Whether a piece of a line leaves a strand in the strand's own direction."""
    end = np.argwhere(place).mean(axis=0)
    before, after = (np.argwhere(each) - end for each in (strands, piece))
    before, after = (each[np.linalg.norm(each, axis=1) <= _NEAR] for each in (before, after))
    if not (len(before) and len(after)):
        return False
    coming, going = -before.mean(axis=0), after.mean(axis=0)
    return bool(coming @ going > _ALONG * np.linalg.norm(coming) * np.linalg.norm(going))
