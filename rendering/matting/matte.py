"""Soft alpha: which share of each pixel belongs to a moving part.

Masks from people and from segmentation are often hard-edged, or end a pixel or two inside the part's drawn outline.
An outline pixel that stays behind is seen as a ghost, a background pixel that goes along as a halo. So the
mask is first grown over the outline that runs along it, and hard edges become shares that follow the colours.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import window_around
from .line_fill import filled_behind_lines
from .mask_edges import FAINT, LEAST_CONTRAST, SOLID, SQUARE, WIDE, grown, hard_edge, inner_colour, mean_near
from .measured_alpha import measured_alpha
from .outline_colour import coloured_outline
from .raised_alpha import INEXPLICABLE, raised_alpha
from .solved_alpha import solved_alpha

__all__ = ["fitting_plate", "in_levels", "is_outlined", "mixed_rim", "soft_alpha", "with_outline"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# An outline beside this share of a mask's whole edge is none by chance.
_OUTLINED = 0.45
# An outline is darker than what lies beyond by this, in the mean along the edge.
_TOLERANCE = 0.055
_SPECK = 20
# Where an outline runs along more of a part's edge, what is left is where there is none.
_WHOLE = 0.97
# Of a gap that is nowhere deeper, outlines are all that is seen [px].
_LEAST_DEPTH = 2
# What decides whether an edge is hard lies within this, where a blur of 5 px ends [px].
_RIM_MARGIN = 24
_HALF = 0.5
# Of colours in 255 levels, those that stay within a little less than half a level of each other round to the same.
_ROUNDING = 0.49 / 255
_LEVEL_ERROR = 1e-3
_LUMINANCE = np.array([0.299, 0.587, 0.114], dtype=np.float32)


def with_outline(image: FloatImage, mask: FloatImage, *, reach: int = 5) -> Mask:
    """Where a part is, its drawn outline included.

    An outline is what runs along a hard edge of the mask, hangs together with it and is darker than what lies
    beyond ``reach``, or, in gaps narrower than that, than what is in their middle. A mask whose edge is soft has been
    drawn or cut with care, and ends where the part does, unless such an outline runs along about half of it: then the
    mask has been made smaller or blurred afterwards.
    The pixels are compared one pixel of distance after the other, in the mean along the edge, so that the
    background's own texture cancels; the difference must exceed how much those beyond differ among themselves.
    Where an outline is seen along most of a part, in the mask or beside it, its ink's colour tells the rest.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        mask: soft mask in 0 to 1, shape [h, w].
        reach: how far an outline may lie outside the mask [px].

    Returns:
        True in the part, shape [h, w]; includes every pixel of the mask above 0.02.
    """
    support = mask > FAINT
    if not support.any() or support.all():
        return support
    window = window_around(support, margin=4 * reach)
    inside, lightness = support[window], image[window] @ _LUMINANCE
    distance = cv2.distanceTransform((~inside).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    beyond = (distance > reach) & (distance <= 2 * reach) | _middle_of_gaps(distance, reach)
    reference, known = mean_near(lightness, beyond)
    spread = np.sqrt(np.maximum(mean_near(lightness * lightness, beyond)[0] - reference * reference, 0))
    outline = np.zeros_like(inside)
    for step in range(reach):
        ring = (distance > step) & (distance <= step + 1)
        outline |= ring & known & (mean_near(lightness, ring)[0] < reference - spread - _TOLERANCE)
    joined = _joined(inside, outline, reach)
    rim = grown(inside, SQUARE) & ~inside
    if (joined & rim).sum() < _OUTLINED * rim.sum():
        outline &= hard_edge(mask[window], inside)
        joined = _joined(inside, outline, reach)
    inked = _hidden_outline(image[window], mask[window], inside, rim & ~joined, reach=reach)
    if inked.any():
        joined = _joined(inside, outline | inked, reach)
    support[window] = joined
    return support


def _hidden_outline(image: FloatImage, mask: FloatImage, inside: Mask, rest: Mask, *, reach: int) -> Mask:
    """Where an outline that is seen along most of a part goes on in front of what is as dark or as varied as it.

    A mask that has been made smaller has such an outline within it here and leaves it outside there.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        mask: soft mask in 0 to 1, shape [h, w].
        inside: where that shows something of the part, shape [h, w].
        rest: the pixels next to it along which no outline has been found, shape [h, w].
        reach: how far an outline may lie outside the mask [px].

    Returns:
        Pixels of the outline outside the mask, shape [h, w].
    """
    edge = inside & grown(~inside, SQUARE)
    lined = edge & ((inner_colour(image, inside) - image) @ _LUMINANCE > _TOLERANCE)
    bare = rest & hard_edge(mask, inside) & ~grown(lined, SQUARE)
    share = float(bare.sum()) / max(1, int((grown(inside, SQUARE) & ~inside).sum()))
    if not 1 - _WHOLE < share <= 1 - _OUTLINED:
        return np.zeros_like(inside)
    near = grown(bare, np.ones((2 * reach + 1,) * 2, np.uint8))
    return coloured_outline(image, inside, reach=reach, as_dark=False) & near


def _middle_of_gaps(distance: FloatImage, reach: int) -> Mask:
    """The middle of gaps in which nothing is farther from the part than an outline may lie, shape [h, w].

    Args:
        distance: of each pixel from the part [px], shape [h, w].
        reach: how far an outline may lie outside the part [px].
    """
    deepest = cv2.dilate(distance, np.ones((2 * reach + 3,) * 2, np.uint8))
    return (deepest <= reach) & (deepest >= _LEAST_DEPTH) & (distance > deepest - 1)


def mixed_rim(mask: FloatImage, support: Mask) -> Mask:
    """Pixels just outside a part that may show something of it, shape [h, w].

    A hard edge cuts through pixels that show both sides; where an outline was found, it has been included already.

    Args:
        mask: soft mask in 0 to 1, shape [h, w].
        support: where the part is, from ``with_outline``; shape [h, w].
    """
    rim, inside = np.zeros(mask.shape, dtype=bool), mask > FAINT
    if inside.any():
        window = window_around(inside, margin=_RIM_MARGIN)
        there = inside[window]
        rim[window] = grown(there, SQUARE) & ~support[window] & hard_edge(mask[window], there)
    return rim


def soft_alpha(image: FloatImage, plate: FloatImage, mask: FloatImage, support: Mask) -> FloatImage:
    """Share of each pixel that belongs to a part, in 0 to 1, shape [h, w].

    Along hard edges it is solved for; where the mask leaves out the drawn outline it is measured, because the line's
    own colours, dark beside any, would mislead a solver that explains colours by those around. A soft edge is taken as
    it is, unless the picture denies it by much.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        plate: what is behind the part, at least up to two pixels around ``support``; shape [h, w, 3].
        mask: soft mask in 0 to 1, shape [h, w].
        support: where the part is, from ``with_outline``; shape [h, w].
    """
    found = measured_alpha if _is_outlined(image, mask > FAINT, support) else solved_alpha
    alpha = filled_behind_lines(found(image, plate, mask, support), mask, support)
    # What a mask wants soft where its part shows no edge reaches far in after a wide blur.
    deep = (alpha > _HALF) & (alpha < 1) & ~grown(~support, WIDE)
    alpha = raised_alpha(image, plate, alpha, deep, beyond=INEXPLICABLE)
    # The last percents of a mask that nowhere becomes quite white would leave black of the part behind as black.
    return raised_alpha(image, plate, alpha, (alpha > SOLID) & (alpha < 1), beyond=LEAST_CONTRAST)


def is_outlined(image: FloatImage, inside: Mask) -> bool:
    """Whether an outline of a part is found just outside of a hard mask, along much of its edge.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        inside: the mask, shape [h, w].
    """
    return _is_outlined(image, inside, with_outline(image, inside.astype(np.float32)))


def _is_outlined(image: FloatImage, inside: Mask, support: Mask) -> bool:
    """Whether a line darker than the part itself runs along much of its mask's edge, just outside."""
    rim = grown(inside, SQUARE) & ~inside
    line = support & rim
    if not line.any() or line.sum() < _OUTLINED * rim.sum():
        return False
    darker = (inner_colour(image, inside) - image)[line] @ _LUMINANCE
    return bool(darker.mean() > _TOLERANCE)


def in_levels(image: FloatImage) -> bool:
    """Whether the colours, in 0 to 1, are those of an 8-bit picture."""
    levels = image * 255
    return bool((np.abs(levels - np.rint(levels)) < _LEVEL_ERROR).all())


def fitting_plate(image: FloatImage, plate: FloatImage, alpha: FloatImage, *, rounded: bool = False) -> FloatImage:
    """The plate changed as little as needed for a real colour over it to give the picture.

    I = alpha F + (1 - alpha) B with F in 0 to 1 needs (I - alpha) / (1 - alpha) <= B <= I / (1 - alpha), where a
    rounded I is known to half a level only. Were alpha raised instead, slight errors of the plate would make light or
    dark fringes that move with the part.

    Args:
        image: I, RGB in 0 to 1, shape [h, w, 3].
        plate: B, RGB in 0 to 1, shape [h, w, 3].
        alpha: in 0 to 1, shape [h, w].
        rounded: the picture's colours have been rounded to 255 levels, and it is enough for them to round to the same.

    Returns:
        The plate where alpha is above 0, the picture elsewhere; shape [h, w, 3].
    """
    fitting = np.where(alpha[..., None] > 0, plate, image)
    at = np.nonzero((alpha > 0) & (alpha < 1))
    share = alpha[at][:, None]
    # The plate will be rounded as well, and shows by 1 - alpha.
    slack = np.maximum(_ROUNDING - (1 - share) * np.float32(0.5 / 255), 0) if rounded else np.float32(0)
    lowest, highest = (image[at] - slack - share) / (1 - share), (image[at] + slack) / (1 - share)
    fitting[at] = np.clip(np.clip(plate[at], lowest, highest), 0, 1)
    return fitting


def _joined(inside: Mask, outline: Mask, reach: int) -> Mask:
    """The part with the outline pixels that hang together with it; without the specks that they enclose."""
    joined = inside.copy()
    for _ in range(reach):
        joined |= outline & grown(joined, SQUARE)
    joined |= _between(outline & ~joined, joined & ~inside)
    # The line's outermost pixels are too faint to be told by their lightness.
    added = grown(joined & ~inside, SQUARE)
    joined |= added
    _, labels, statistics, _ = cv2.connectedComponentsWithStats((~joined).astype(np.uint8), connectivity=4)
    small = statistics[:, cv2.CC_STAT_AREA] < _SPECK
    small[0] = False
    return joined | (small[labels] & grown(added, SQUARE))


def _between(outline: Mask, found: Mask) -> Mask:
    """Stretches of an outline that go on from found ones at either end."""
    _, stretches = cv2.connectedComponents(outline.astype(np.uint8), connectivity=8)
    _, ends = cv2.connectedComponents((grown(outline, SQUARE) & found).astype(np.uint8), connectivity=8)
    (row, column), padded = np.nonzero(outline), np.pad(ends, 1)
    beside = np.stack([padded[row + down, column + right] for down in range(3) for right in range(3)])
    stretch = np.broadcast_to(stretches[outline], beside.shape)[beside > 0]
    met = np.unique(np.stack([stretch, beside[beside > 0]]), axis=1)
    several = np.bincount(met[0], minlength=int(stretches.max()) + 1) > 1
    return np.asarray(outline & several[stretches])
