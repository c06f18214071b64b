"""Masks as people and networks make them - grown, shrunk, blurred, scaled, painted by hand - made regular.

Such a mask says only about where a part ends. What a soft edge leaves outside stays behind as a ghost of the part's
outline when the part moves, what a wide one takes in goes along as a halo. A regular mask ends at the part's edge, as
the picture shows it, and its edge is hard or as soft as one pixel; the matting does the rest.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.interruption import checkpoint
from ..pictures import nearest_pixels, window_around
from .kept_masks import KeptMasks
from .mask_edges import CROSS, FAINT, SQUARE, edge_strength, grown
from .mask_forms import NOISE, MaskEdge, edge_of, from_edge, in_blocks, is_noisy, step_of, up_to_white
from .moved_edges import (
    LEAST_STEP,
    NEARER,
    REACH,
    WIDEST,
    displacement,
    expected,
    searched,
    share_moved,
    with_all_strands,
    without_new_specks,
)

__all__ = ["regular_mask"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

_HALF = 0.5
# Transitions of anti-aliased edges are mostly narrower than the first width; those from the second on are blurred [px].
_ANTI_ALIASED = 1.9
_BLURRED = 3.0
# Sigma of a Gaussian blur as a share of the width over which an edge changes.
_SIGMA = 0.3
# Where less of an edge would move, the mask has been made with care and is taken at its word.
_MOVED = 0.3
# Steps from this height on miss the part's edge by more than the matting mends [px].
_COARSE = 3
_MARGIN = 40
# A soft piece this many times as long as it is wide is no accident.
_LONG = 3
# Within a soft transition an edge of the picture is looked for along these levels of the mask.
_LEVELS = (0.1, 0.3, 0.5, 0.7, 0.9)


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
    mask = up_to_white(mask)
    if not (mask > _HALF).any() or (mask > _HALF).all():
        return mask
    margin = _MARGIN
    while True:
        window = window_around(mask > FAINT, margin=margin)
        found = _REGULAR(image[window], mask[window])
        # A strand may go on beyond what has been looked at.
        if not (_added(mask, window, found) & _on_rim(window, mask.shape)).any():
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


def _added(mask: FloatImage, window: tuple[slice, slice], found: FloatImage) -> Mask:
    """What has been found in a window that the mask did not have, shape of the window."""
    return np.asarray((found > _HALF) & (mask[window] <= _HALF))


def _on_rim(window: tuple[slice, slice], size: tuple[int, ...]) -> Mask:
    """Where a window ends within the picture, shape of the window."""
    rows, columns = window
    rim = np.zeros((rows.stop - rows.start, columns.stop - columns.start), dtype=bool)
    rim[0], rim[-1] = rows.start > 0, rows.stop < size[0]
    rim[:, 0] |= columns.start > 0
    rim[:, -1] |= columns.stop < size[1]
    return rim


def _regular(image: FloatImage, mask: FloatImage) -> FloatImage:
    checkpoint()
    edge = edge_of(mask)
    noisy = edge.median_width() < _BLURRED and is_noisy(mask)
    if noisy:
        mask = np.where(mask < NOISE, np.float32(0), np.where(mask > 1 - NOISE, np.float32(1), mask))
    blurred = edge.width > _BLURRED
    shape, displaced = _shape(image, mask, edge, blurred)
    shape = without_new_specks(shape, edge.inside)
    moved = shape != edge.inside
    soft = noisy or displaced or edge.median_width() > _ANTI_ALIASED or in_blocks(mask)
    rewritten = blurred | grown(moved, SQUARE) | soft
    away = np.minimum(from_edge(shape), from_edge(edge.inside)) if soft else from_edge(shape)
    near = away <= REACH + np.minimum(edge.width, WIDEST)
    # Where the picture has no edge, a soft transition is what somebody wanted.
    wanted = blurred & (edge_strength(image, shape) < LEAST_STEP) if blurred.any() else blurred
    if wanted.any():
        wanted &= _long(wanted, shape, edge) | ~_shows_edge(image, mask, shape)
    # Where a slightly soft edge stays in its place, it says between pixels where that is.
    narrowed = np.clip(_HALF + (mask - _HALF) * np.maximum(edge.width, 1), 0, 1)
    stays = ~displaced & ~noisy & (edge.width <= _BLURRED) & ((narrowed > _HALF) == shape) & ~in_blocks(mask)
    return np.where(rewritten & near & ~wanted, np.where(stays, narrowed, shape), mask).astype(np.float32)


_REGULAR = KeptMasks(_regular)


def _shows_edge(image: FloatImage, mask: FloatImage, shape: Mask) -> Mask:
    """Where the picture has an edge somewhere in the transition of a mask, shape [h, w].

    Along the edge that was found it may be missed for a few pixels; the soft wedge left there would cut its ink in two.
    """
    levels = [shape, *(mask > level for level in _LEVELS)]
    return np.max([edge_strength(image, each) for each in levels], axis=0) >= LEAST_STEP


def _long(wanted: Mask, shape: Mask, edge: MaskEdge) -> Mask:
    """Where what is wanted goes on along the edge for much longer than the transition is wide, shape [h, w]."""
    line = shape & grown(~shape, CROSS)
    _, pieces = cv2.connectedComponents((line & wanted).astype(np.uint8), connectivity=8)
    length = np.bincount(pieces[line], minlength=int(pieces.max()) + 1)
    return np.asarray((line & (length[pieces] > _LONG * edge.width)).ravel()[nearest_pixels(line)[1]])


def _shape(image: FloatImage, mask: FloatImage, edge: MaskEdge, blurred: Mask) -> tuple[Mask, bool]:
    """Where the part is, and whether its hard edges as well are elsewhere than those of the mask."""
    coarse = step_of(mask) >= _COARSE
    shape, moved = searched(image, mask, edge, reach=REACH, exact=not coarse)
    displaced = coarse or share_moved(moved, edge.line & ~blurred) > _MOVED
    if not displaced:
        shape = np.where(moved & blurred, shape, edge.inside)
    # A mask that has only been blurred is right in the mean.
    shifted = abs(displacement(image, shape, edge.inside)[0]) >= 1 and share_moved(moved & blurred, edge.line) > _MOVED
    if displaced or shifted:
        # From where it has got to: what the mask had lost has a core to start from now.
        again = expected(image, shape, edge.inside).astype(np.float32)
        shape, _ = searched(image, again, edge_of(again), reach=NEARER)
    shape = shape if displaced else np.where(blurred, shape, edge.inside)
    sigma = _SIGMA * edge.median_width() if edge.median_width() > _BLURRED else 0.0
    return with_all_strands(image, shape, mask, sigma=sigma) if displaced or sigma else shape, displaced
