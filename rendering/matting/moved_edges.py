"""Edges of masks moved to where the picture has a stronger one, and to where they are expected."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import nearest_pixels, window_around
from .drawn_lines import OUTLINE_REACH, disc, with_ink
from .edge_search import found_shape
from .lost_strands import lost_lines, lost_strands, taken_off_of
from .mask_edges import CROSS, SQUARE, edge_strength, grown, mean_near
from .mask_forms import MaskEdge, edge_of, from_edge
from .matte import is_outlined
from .outline_colour import coloured_outline
from .strand_ends import coloured_ends, leading_away, narrow_strands, strand_ends

__all__ = [
    "LEAST_STEP",
    "NEARER",
    "REACH",
    "WIDEST",
    "displacement",
    "expected",
    "searched",
    "share_moved",
    "with_all_strands",
    "without_new_specks",
]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

REACH = 10.0
"""The edge may lie this far from the mask's, and as far again as half of a soft transition is wide [px]."""

NEARER = 5.0
"""The same for a mask whose edge has been moved before [px]."""

WIDEST = 30.0
"""Transitions wider than this count no more [px]."""

LEAST_STEP = 0.04
"""An edge that is found elsewhere must differ by this much in colour."""

_HALF = 0.5
# And be this much stronger than the mask's own.
_STRONGER = 1.15
# Colours this likely are the part's: those of neither side, as of outlines, are less (see found_shape).
_COLOURED = 0.9
# So far from an edge its strength is not seen [px].
_APART = 8.0
# An edge this strong is a clear one; the middle half of these must lie within this range of distances [px].
_CLEAR = 2 * LEAST_STEP
_CONSISTENT = 2.5
# Strands are looked for so many times, and their edges near by.
_PIECES = 8
_AROUND_STRANDS = np.ones((11, 11), np.uint8)
_NARROW = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (9, 9))
_TOUCHING = np.ones((5, 5), np.uint8)
_MARGIN = 40
# Smaller pieces and holes are none of a part's [px].
_SPECK = 20


def searched(
    image: FloatImage, mask: FloatImage, edge: MaskEdge, *, reach: float, exact: bool = True
) -> tuple[Mask, Mask]:
    """The shape with its edge moved where the picture has a stronger one, and where that is.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3], or with opacity as a further channel.
        mask: soft mask in 0 to 1, shape [h, w].
        edge: the mask's.
        reach: how far the edge may lie from the mask's, where that is hard [px].
        exact: the mask's edge may be right to the pixel; otherwise any edge of the picture is better.
    """
    limit = np.asarray(reach + _HALF * np.minimum(edge.width, WIDEST), dtype=np.float32)
    shape, likely = found_shape(image, mask, limit)
    shape = shape | coloured_ends(shape, likely > _COLOURED, edge.inside)
    changed = shape != edge.inside
    agreed = mean_near(np.where(shape, likely, 1 - likely), changed, sigma=3.0)[0]
    strength = edge_strength(image, shape)
    given = edge_strength(image, edge.inside)
    better = strength > (np.maximum(_STRONGER * given, LEAST_STEP) if exact else LEAST_STEP)
    better |= _closed(shape & ~edge.inside, shape, given)
    ends = leading_away(shape, edge.inside)
    if exact and ends.any():
        window = window_around(ends, margin=_MARGIN)
        better[window] |= ends[window] & _better_ended(image[window], shape[window], edge.inside[window])
    moved = changed & better & (agreed > _HALF)
    # Changes as thin as one pixel are left to the matting.
    thick = cv2.morphologyEx(moved.astype(np.uint8), cv2.MORPH_OPEN, np.ones((2, 2), np.uint8)) > 0
    moved &= grown(thick, SQUARE) | grown(ends, SQUARE)
    return np.where(moved, shape, edge.inside), moved


def displacement(image: FloatImage, shape: Mask, given: Mask) -> tuple[float, float]:
    """How far outside of a mask's edge the clear edges of a found shape lie.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3], or with opacity as a further channel.
        shape: what has been found, shape [h, w].
        given: the mask before, shape [h, w].

    Returns:
        Median, negative where the mask is too wide, and the range of the middle half [px]; 0 without clear edges.
    """
    away = _outside(given)[_clear(image, shape)]
    if not away.size:
        return 0.0, 0.0
    low, middle, high = np.percentile(away, (25, 50, 75))
    return float(middle), float(high - low)


def expected(image: FloatImage, shape: Mask, given: Mask) -> Mask:
    """A shape that has been found, and where the picture shows no clear edge the mask as it probably was.

    A mask that has been grown or shrunk misses by about the same everywhere. Where it ends within one colour, the
    picture does not show by how much; the edges that it does show tell. For the arguments see ``displacement``.
    """
    middle, spread = displacement(image, shape, given)
    if spread > _CONSISTENT or abs(middle) < 1:
        return shape
    line = shape & grown(~shape, CROSS)
    unsure = (line & ~_clear(image, shape)).ravel()[nearest_pixels(line)[1]]
    return np.where(unsure, _outside(given) <= middle, shape)


def with_all_strands(image: FloatImage, shape: Mask, mask: FloatImage, *, sigma: float = 0) -> Mask:
    """The shape with the strands that the mask has lost, and what nothing else of a picture with opacity holds.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3], or with opacity as a further channel.
        shape: what has been found, shape [h, w].
        mask: as it was given, in 0 to 1, shape [h, w].
        sigma: how much that has been blurred [px].
    """
    if image.shape[2] > 3:
        shape = shape | _hanging(image[..., 3], shape)
    middle, spread = displacement(image, shape, mask > _HALF)
    # At least three of four clear edges lie outside of the mask.
    smaller = middle >= 1 and middle > spread / 2
    # With strands each find would allow a wider one.
    off = taken_off_of(shape, mask > _HALF) if smaller else 0
    whole = _with_strands(image, shape, mask, off, sigma)
    if sigma:
        whole = whole | lost_lines(image, whole, mask, (mask > _HALF) | (whole & ~shape), sigma=sigma)
    # An outline along most of it is found by the matting.
    return with_ink(image, whole) if smaller and not is_outlined(image[..., :3], whole) else whole


def without_new_specks(shape: Mask, given: Mask) -> Mask:
    """The shape without pieces and holes of a few pixels that the mask did not have."""
    for inside in (False, True):
        side, before = (shape, given) if inside else (~shape, ~given)
        _, labels, boxes, _ = cv2.connectedComponentsWithStats(side.astype(np.uint8), connectivity=4)
        specks = boxes[:, cv2.CC_STAT_AREA] < _SPECK
        specks[np.unique(labels[before & side])] = False
        specks[0] = False
        shape = shape ^ specks[labels]
    return shape


def share_moved(moved: Mask, line: Mask) -> float:
    """How much of an edge moves."""
    return int((grown(moved, _TOUCHING) & line).sum()) / max(1, int(line.sum()))


def _clear(image: FloatImage, shape: Mask) -> Mask:
    """The outermost pixels of a shape where the picture has a clear edge."""
    return shape & grown(~shape, CROSS) & (edge_strength(image, shape) > _CLEAR)


def _outside(given: Mask) -> FloatImage:
    """How far outside of a mask's outermost pixels each pixel lies [px], shape [h, w]."""
    return np.asarray(np.where(given, 1 - from_edge(given), from_edge(given)), dtype=np.float32)


def _better_ended(image: FloatImage, shape: Mask, given: Mask) -> Mask:
    """Where a shape has a stronger edge than a mask, counting only what they do not share, shape [h, w].

    The end of a strand is judged by the cut across it, and not by the mask's good edges on either side of the cut.
    """
    strength = edge_strength(image, shape, apart_from=given)
    return np.asarray(strength > np.maximum(_STRONGER * edge_strength(image, given, apart_from=shape), LEAST_STEP))


def _closed(added: Mask, shape: Mask, strength: FloatImage) -> Mask:
    """Where an edge of the mask that the picture does not show is gone, as of holes made wider than they are."""
    count, labels = cv2.connectedComponents(added.astype(np.uint8), connectivity=8)
    is_open = np.zeros(count, dtype=bool)
    is_open[labels[added & grown(~shape, SQUARE)]] = True
    far = ~is_open[labels] | (from_edge(shape) > _APART)
    return added & far & (strength < LEAST_STEP)


def _with_strands(image: FloatImage, shape: Mask, mask: FloatImage, off: int, sigma: float) -> Mask:
    """The shape with the strands that the mask has lost; a strand of several colours is found piece by piece."""
    given = mask > _HALF
    for _ in range(_PIECES):
        strands = lost_strands(image, shape, mask, taken_off=off, sigma=sigma)
        if not strands.any():
            break
        near = grown(strands, _AROUND_STRANDS)
        window = window_around(strands, margin=_MARGIN)
        start = (shape | strands)[window].astype(np.float32)
        edged, _ = searched(image[window], start, edge_of(start), reach=REACH)
        joined = shape | strands
        joined[window] = np.where(near[window], edged | strands[window], joined[window])
        shape = joined
    if off:
        # Nearer to the mask its edge has been looked for already.
        shape = shape | strand_ends(image, shape, shape & ~grown(given, disc(int(REACH))))
    return shape | _outline_of_strands(image, shape, narrow_strands(shape, shape & ~given))


def _outline_of_strands(image: FloatImage, shape: Mask, strands: Mask) -> Mask:
    """The outline along strands in front of what is as dark, shape [h, w]."""
    outline = np.zeros_like(shape)
    if strands.any():
        window = window_around(strands, margin=_MARGIN)
        near = grown(strands[window], disc(OUTLINE_REACH))
        outline[window] = coloured_outline(image[window], shape[window], reach=OUTLINE_REACH) & near
    return outline


def _hanging(opacity: FloatImage, shape: Mask) -> Mask:
    """Narrow pieces of a picture with opacity that nothing but the part holds, as the tips of strands."""
    rest = (opacity > _HALF) & ~shape
    count, labels = cv2.connectedComponents(rest.astype(np.uint8), connectivity=8)
    hanging, wide = np.zeros(count, dtype=bool), cv2.erode(rest.astype(np.uint8), _NARROW) > 0
    hanging[labels[rest & grown(shape, SQUARE)]] = True
    hanging[labels[wide]] = False
    hanging[0] = False
    return hanging[labels]
