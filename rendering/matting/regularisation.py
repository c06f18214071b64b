"""Masks as people and networks make them - grown, shrunk, blurred, scaled, painted by hand - made regular.

Such a mask says only about where a part ends. What a soft edge leaves outside stays behind as a ghost of the part's
outline when the part moves, what a wide one takes in goes along as a halo. A regular mask ends at the part's edge, as
the picture shows it, and its edge is hard or as soft as one pixel; the matting does the rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import nearest_pixels, window_around
from .edge_search import found_shape
from .lost_strands import lost_strands
from .mask_edges import CROSS, FAINT, SQUARE, edge_strength, grown, mean_near

__all__ = ["regular_mask"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

_HALF = 0.5
# The edge may lie this far from the mask's, and as far again as half of a soft transition is wide [px].
_REACH = 10.0
_WIDEST = 30.0
# What differs less from white is white: even so little of the part's black missing would blacken what is behind it.
_WHITE = 1 - 0.5 / 255
# Noise around edges, as compression makes it, stays below this much and below this share of the edge's pixels.
_NOISE = 0.1
_NOISY = 0.1
# Transitions of anti-aliased edges are mostly narrower than the first width; those from the second on are blurred [px].
_ANTI_ALIASED = 1.9
_BLURRED = 3.0
# Share of soft pixels in uniform blocks from which on a mask has been enlarged without smoothing.
_BLOCKS = 0.25
# An edge that is found elsewhere must be this much stronger than the mask's own, and differ by this much in colour.
_STRONGER = 1.15
_LEAST_STEP = 0.04
# So far from an edge its strength is not seen [px].
_APART = 8.0
# Where less of an edge would move, the mask has been made with care and is taken at its word.
_MOVED = 0.3
# Strands are looked for so many times, and their edges near by.
_PIECES = 8
_AROUND_STRANDS = np.ones((11, 11), np.uint8)
_NARROW = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (9, 9))
_TOUCHING = np.ones((5, 5), np.uint8)
_MARGIN = 40


@dataclass(frozen=True, eq=False)
class _Edge:
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


def regular_mask(image: FloatImage, mask: FloatImage) -> FloatImage:
    """A mask whose edge lies where the picture has one.

    A soft edge becomes a hard one, and moves onto an edge of the picture if there is a stronger one near by; a hard
    edge moves if much of the mask's edge does. A mask made with care comes back as it was, and so does whatever lies
    between colours that cannot be told apart. A mask that nowhere becomes white is scaled up to white.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3], or with opacity as a further channel.
        mask: soft mask in 0 to 1, shape [h, w].

    Returns:
        The mask in 0 to 1, shape [h, w].

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.matting import regular_mask
        >>> picture = np.ones((60, 60, 3), np.float32)
        >>> picture[10:50, 10:50] = (0.8, 0.2, 0.1)
        >>> mask = np.zeros((60, 60), np.float32)
        >>> mask[12:48, 12:48] = 1
        >>> regular_mask(picture, mask).shape
        (60, 60)
    """
    mask = _up_to_white(mask)
    if not (mask > _HALF).any() or (mask > _HALF).all():
        return mask
    margin = _MARGIN
    while True:
        window = window_around(mask > FAINT, margin=margin)
        found = _regular(image[window], mask[window])
        # A strand may go on beyond what has been looked at.
        if found.shape == mask.shape or not _meets_border(found, mask[window]):
            break
        margin *= 2
    regular = mask.copy()
    regular[window] = found
    return np.where(_empty(image), np.float32(0), regular)


def _empty(image: FloatImage) -> Mask:
    """Where there is nothing to see in a picture with opacity, shape [h, w]; nowhere in one without."""
    if image.shape[2] == 3:
        return np.zeros(image.shape[:2], dtype=bool)
    return ~grown(image[..., 3] > FAINT, SQUARE)


def _meets_border(found: FloatImage, mask: FloatImage) -> bool:
    """Whether something that the mask did not have has been found to go on to the border."""
    added = (found > _HALF) & (mask <= _HALF)
    return bool(added[0].any() or added[-1].any() or added[:, 0].any() or added[:, -1].any())


def _regular(image: FloatImage, mask: FloatImage) -> FloatImage:
    edge = _edge_of(mask)
    noisy = edge.median_width() < _BLURRED and _is_noisy(mask)
    if noisy:
        mask = np.where(mask < _NOISE, np.float32(0), np.where(mask > 1 - _NOISE, np.float32(1), mask))
    blurred = edge.width > _BLURRED
    shape, moved = _searched(image, mask, edge)
    displaced = _share(moved, edge.line & ~blurred) > _MOVED
    if displaced:
        # From where it has got to: strands that the mask had lost have a core to start from now.
        again = shape.astype(np.float32)
        shape, further = _searched(image, again, _edge_of(again))
        moved |= further
        before = shape
        if image.shape[2] > 3:
            shape = shape | _hanging(image[..., 3], shape)
        shape = _with_strands(image, shape, edge.inside)
        moved |= shape != before
    else:
        moved &= blurred
        shape = np.where(moved, shape, edge.inside)
    soft = noisy or displaced or edge.median_width() > _ANTI_ALIASED or _in_blocks(mask)
    rewritten = blurred | grown(moved, SQUARE) | soft
    away = np.minimum(_distance(shape), _distance(edge.inside)) if soft else _distance(shape)
    near = away <= _REACH + np.minimum(edge.width, _WIDEST)
    # Where the picture has no edge, a soft transition is what somebody wanted.
    wanted = blurred & (edge_strength(image, shape) < _LEAST_STEP)
    # Where a slightly soft edge stays in its place, it says between pixels where that is.
    narrowed = np.clip(_HALF + (mask - _HALF) * np.maximum(edge.width, 1), 0, 1)
    stays = ~displaced & ~noisy & (edge.width <= _BLURRED) & ((narrowed > _HALF) == shape) & ~_in_blocks(mask)
    return np.where(rewritten & near & ~wanted, np.where(stays, narrowed, shape), mask).astype(np.float32)


def _share(moved: Mask, line: Mask) -> float:
    """How much of an edge moves."""
    return int((grown(moved, _TOUCHING) & line).sum()) / max(1, int(line.sum()))


def _searched(image: FloatImage, mask: FloatImage, edge: _Edge) -> tuple[Mask, Mask]:
    """The shape with its edge moved where the picture has a stronger one, and where that is."""
    reach = np.asarray(_REACH + _HALF * np.minimum(edge.width, _WIDEST), dtype=np.float32)
    shape, likely = found_shape(image, mask, reach)
    changed = shape != edge.inside
    agreed = mean_near(np.where(shape, likely, 1 - likely), changed, sigma=3.0)[0]
    strength = edge_strength(image, shape)
    given = edge_strength(image, edge.inside)
    better = strength > np.maximum(_STRONGER * given, _LEAST_STEP)
    better |= _closed(shape & ~edge.inside, shape, given)
    moved = changed & better & (agreed > _HALF)
    # Changes as thin as one pixel are left to the matting.
    thick = cv2.morphologyEx(moved.astype(np.uint8), cv2.MORPH_OPEN, np.ones((2, 2), np.uint8)) > 0
    moved &= grown(thick, SQUARE)
    return np.where(moved, shape, edge.inside), moved


def _closed(added: Mask, shape: Mask, strength: FloatImage) -> Mask:
    """Where an edge of the mask that the picture does not show is gone, as of holes made wider than they are."""
    count, labels = cv2.connectedComponents(added.astype(np.uint8), connectivity=8)
    is_open = np.zeros(count, dtype=bool)
    is_open[labels[added & grown(~shape, SQUARE)]] = True
    far = ~is_open[labels] | (_distance(shape) > _APART)
    return added & far & (strength < _LEAST_STEP)


def _with_strands(image: FloatImage, shape: Mask, given: Mask) -> Mask:
    """The shape with the strands that the mask has lost; a strand of several colours is found piece by piece."""
    for _ in range(_PIECES):
        strands = lost_strands(image, shape, given)
        if not strands.any():
            break
        near = grown(strands, _AROUND_STRANDS)
        window = window_around(strands, margin=_MARGIN)
        start = (shape | strands)[window].astype(np.float32)
        edged, _ = _searched(image[window], start, _edge_of(start))
        joined = shape | strands
        joined[window] = np.where(near[window], edged | strands[window], joined[window])
        shape = joined
    return shape


def _hanging(opacity: FloatImage, shape: Mask) -> Mask:
    """Narrow pieces of a picture with opacity that nothing but the part holds, as the tips of strands."""
    rest = (opacity > _HALF) & ~shape
    count, labels = cv2.connectedComponents(rest.astype(np.uint8), connectivity=8)
    hanging, wide = np.zeros(count, dtype=bool), cv2.erode(rest.astype(np.uint8), _NARROW) > 0
    hanging[labels[rest & grown(shape, SQUARE)]] = True
    hanging[labels[wide]] = False
    hanging[0] = False
    return hanging[labels]


def _edge_of(mask: FloatImage) -> _Edge:
    inside = mask > _HALF
    line = inside & grown(~inside, CROSS)
    soft = ((mask > 0.05) & (mask < 0.95)).astype(np.float32)
    # So many soft pixels there are for each of the edge.
    there = cv2.GaussianBlur(line.astype(np.float32), (0, 0), 5.0)
    local = cv2.GaussianBlur(soft, (0, 0), 5.0) / np.maximum(there, np.float32(1e-3))
    return _Edge(inside, line, np.where(line, local, np.float32(0)).ravel()[nearest_pixels(line)[1]])


def _up_to_white(mask: FloatImage) -> FloatImage:
    highest = float(mask.max(initial=0))
    if highest <= FAINT:
        return mask
    white = float(np.percentile(mask[mask > _HALF * highest], 90))
    mask = mask / np.float32(white) if white < 0.98 else mask
    return np.where(mask > _WHITE, np.float32(1), mask)


def _is_noisy(mask: FloatImage) -> bool:
    """Whether there are faint specks near the edge, as compression leaves them."""
    inside = mask > _HALF
    faint = (mask > FAINT) & (mask < _NOISE) & (_distance(inside) > 2)
    return int(faint.sum()) > _NOISY * int((inside & grown(~inside, CROSS)).sum())


def _in_blocks(mask: FloatImage) -> bool:
    """Whether the soft pixels come in blocks of one value."""
    corners = np.stack([mask[:-1, :-1], mask[1:, :-1], mask[:-1, 1:], mask[1:, 1:]])
    soft = (corners > 0.05) & (corners < 0.95)
    alike = soft.all(axis=0) & (np.ptp(corners, axis=0) < 1e-3)
    count = int(soft[0].sum())
    return count > 0 and 4 * int(alike.sum()) > _BLOCKS * count


def _distance(shape: Mask) -> FloatImage:
    """From the edge of a shape, on either side [px], shape [h, w]."""
    sides = [cv2.distanceTransform(side.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5) for side in (shape, ~shape)]
    return np.asarray(np.maximum(*sides), dtype=np.float32)
