"""GrabCut on art with outlines: several cuts that take the drawn lines more or less seriously, and their majority.

A line is as often an object's border as it is a strand, a fold or a seam within it, and its darkness does not tell
which. A cut of the picture as drawn stays within the outlines and loses the neighbouring strand; a cut of the picture
with its lines faded into the colours beside them finds the strand, and at times leaks. What most of the cuts agree on
does neither.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import nearest_pixels
from ..sketch import extract_sketch

__all__ = ["cut_by_majority", "grab_cut", "window_of", "without_foreign_lines"]

Mask = NDArray[np.bool_]
Lab = NDArray[np.uint8]

# Half and twice of these, measured as in trimap, change the median overlap by less than 0.01.
_LINES_LEFT = (1.0, 0.5, 0.25)
"""How much of the lines' darkness each cut sees."""
# A sketch is darker than this on a drawn line; lines are narrower than this [px].
_LINE = 0.41
_WIDEST = 4
_SQUARE = np.ones((3, 3), np.uint8)


def cut_by_majority(lab: Lab, trimap: NDArray[np.uint8], iterations: int, seeds: NDArray[np.int_]) -> Mask:
    """Where most cuts find the object, as far as it hangs together with a seed, if only across a line.

    Args:
        lab: the picture, shape [h, w, 3].
        trimap: GrabCut's labels to start from, shape [h, w].
        iterations: rounds of GrabCut.
        seeds: column and row of points on the object, shape [k, 2]; none keeps every part.

    Returns:
        mask, shape [h, w].
    """
    lines = _drawn_lines(lab)
    plain = _without_lines(lab, lines)
    votes = np.zeros(trimap.shape, np.int32)
    for share in _LINES_LEFT:
        votes += grab_cut(cv2.addWeighted(lab, share, plain, 1 - share, 0), trimap, iterations)
    return _connected_to(2 * votes > len(_LINES_LEFT), seeds, lines)


def grab_cut(lab: Lab, trimap: NDArray[np.uint8], iterations: int) -> Mask:
    """GrabCut within the window that is not sure background, the same on every call.

    Args:
        lab: the picture, shape [h, w, 3].
        trimap: GrabCut's labels, shape [h, w]; stays as it is.
        iterations: rounds.
    """
    rows, columns = window_of(trimap != cv2.GC_BGD, margin=4)
    found = np.zeros(trimap.shape, dtype=bool)
    labels = trimap[rows, columns].copy()
    background = (labels == cv2.GC_BGD) | (labels == cv2.GC_PR_BGD)
    if background.any() and not background.all():
        # The colour models start from random clusters: without a seed, equal clicks would give unequal masks.
        cv2.setRNGSeed(0)
        window = np.ascontiguousarray(lab[rows, columns])
        models = np.zeros((1, 65)), np.zeros((1, 65))
        cv2.grabCut(window, labels, None, *models, iterations, cv2.GC_INIT_WITH_MASK)
    found[rows, columns] = (labels == cv2.GC_FGD) | (labels == cv2.GC_PR_FGD)
    return found


def window_of(mask: Mask, *, margin: int) -> tuple[slice, slice]:
    """Rows and columns that hold the mask and a margin [px]."""
    left, top, columns, rows = cv2.boundingRect(mask.astype(np.uint8))
    return slice(max(0, top - margin), top + rows + margin), slice(max(0, left - margin), left + columns + margin)


def without_foreign_lines(mask: Mask, lines: Mask, *, widest: int) -> Mask:
    """The mask without drawn lines that only begin in it: a line that goes on outside belongs to the neighbour.

    Torn off, such an end would move with the part as a dark speck and be missing from the neighbour's outline.

    Args:
        mask: shape [h, w].
        lines: the drawn lines, shape [h, w].
        widest: half the width of what is no more than a line [px].
    """
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * widest + 1, 2 * widest + 1))
    # Beyond the picture's border the part goes on.
    core = cv2.dilate(cv2.erode(mask.astype(np.uint8), disc, borderValue=1), disc)
    body = cv2.dilate(core, _SQUARE, iterations=2) > 0
    count, labels = cv2.connectedComponents((mask & ~body).astype(np.uint8), connectivity=8)
    sizes = np.bincount(labels.ravel(), minlength=count)
    drawn = np.bincount(labels[lines], minlength=count)
    outside = cv2.dilate((lines & ~mask).astype(np.uint8), _SQUARE) > 0
    going_on = np.bincount(labels[outside], minlength=count) > 0
    foreign = going_on & (2 * drawn > sizes)
    foreign[0] = False
    return mask & ~foreign[labels]


def _drawn_lines(lab: Lab) -> Mask:
    """The thin drawn lines with their soft rims; none where the picture holds nothing else."""
    dark = (extract_sketch(cv2.cvtColor(lab, cv2.COLOR_Lab2RGB)) < _LINE).astype(np.uint8)
    # What is wider than a line is a surface, such as the gap between two locks.
    wide = cv2.dilate(cv2.morphologyEx(dark, cv2.MORPH_OPEN, np.ones((_WIDEST,) * 2, np.uint8)), _SQUARE)
    lines = cv2.dilate(dark & (1 - wide), _SQUARE) > 0
    return lines if not lines.all() else np.zeros_like(lines)


def _without_lines(lab: Lab, lines: Mask) -> Lab:
    """The picture with every line pixel in the colour of the nearest pixel beside the line."""
    return lab.reshape(-1, 3)[nearest_pixels(~lines)[1]]


def _connected_to(mask: Mask, seeds: NDArray[np.int_], lines: Mask) -> Mask:
    """The parts that hang together with a seed; everything where none does or no seeds are given."""
    bridged = mask | (lines & (cv2.dilate(mask.astype(np.uint8), _SQUARE, iterations=2) > 0))
    _, labels = cv2.connectedComponents(bridged.astype(np.uint8), connectivity=4)
    chosen = np.unique(labels[seeds[:, 1], seeds[:, 0]])
    chosen = chosen[chosen > 0]
    return mask & np.isin(labels, chosen) if len(chosen) else mask
