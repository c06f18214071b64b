"""What surely and what probably belongs to an object, from a few clicks on it: the start of a GrabCut.

Pictures are made of regions of slowly changing colour, so each point stands for the whole region around it; the
colours of these regions then tell what is probable elsewhere.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .clicked_regions import Looks

__all__ = ["trimap_from_points"]

Mask = NDArray[np.bool_]
Lab = NDArray[np.uint8]

# tests/benchmarks/thresholds.py measures half and twice of these on painted parts: half of _COLOUR_BINS takes 0.07 off
# the median overlap of 0.86, the others change it by less than 0.01.

# Colours are counted in so many steps of each channel.
_COLOUR_BINS = 24
# Colours tell no further from the foreground's hull than this, as a share of the picture's longer side.
_BESIDE_HULL = 0.05
# What is further from the foreground than this share of its size is background.
_MARGIN = 0.4


def trimap_from_points(
    lab: Lab, at: NDArray[np.int_], positive: NDArray[np.bool_], limit: Mask, tolerance: int, *, has_box: bool
) -> NDArray[np.uint8]:
    """GrabCut's labels: sure from the grown regions, likely from their colours, background elsewhere."""
    foreground, background = _grown(lab, at, positive, tolerance)
    trimap = np.full(limit.shape, cv2.GC_PR_BGD, dtype=np.uint8)
    if positive.any():
        trimap[_likely(lab, foreground, background)] = cv2.GC_PR_FGD
        trimap[~_near(foreground)] = cv2.GC_BGD
    else:
        trimap[limit] = cv2.GC_PR_FGD
    if has_box:
        trimap[~limit] = cv2.GC_BGD
    trimap[foreground] = cv2.GC_FGD
    trimap[background] = cv2.GC_BGD
    return trimap


def _grown(lab: Lab, at: NDArray[np.int_], positive: NDArray[np.bool_], tolerance: int) -> tuple[Mask, Mask]:
    """The regions around the positive and around the negative points, without what both reach."""
    looks = Looks(lab)
    regions = {True: np.zeros(lab.shape[:2], bool), False: np.zeros(lab.shape[:2], bool)}
    for point, label in zip(at, positive, strict=True):
        regions[bool(label)] |= looks.region(point, at[positive != label], tolerance)
    both = regions[True] & regions[False]
    for label in (False, True):
        regions[label] &= ~both
    # Positive points last: the foreground keeps at least one pixel even where two points share one at this size.
    for label in (False, True):
        column, row = at[positive == label].T
        regions[not label][row, column] = False
        regions[label][row, column] = True
    return regions[True], regions[False]


def _likely(lab: Lab, foreground: Mask, background: Mask) -> Mask:
    """Pixels near the foreground's hull whose colour is commoner in it than in what surely lies beside it."""
    distance = _distance_from_hull(foreground)
    apart = (distance > 0) & ~foreground
    inside = _histogram(lab, foreground)
    outside = _histogram(lab, background) + _histogram(lab, apart)
    cell = tuple(np.moveaxis(lab.astype(np.int32) * _COLOUR_BINS // 256, 2, 0))
    return (inside[cell] > outside[cell]) & (distance < _BESIDE_HULL * max(lab.shape))


def _near(foreground: Mask) -> Mask:
    """A window about the foreground with a margin: colours further away do not matter."""
    ys, xs = np.nonzero(foreground)
    least = _BESIDE_HULL * max(foreground.shape)
    margin_x, margin_y = (int(max(_MARGIN * np.ptp(values), least)) for values in (xs, ys))
    window = np.zeros(foreground.shape, dtype=bool)
    window[
        max(0, ys.min() - margin_y) : ys.max() + margin_y + 1, max(0, xs.min() - margin_x) : xs.max() + margin_x + 1
    ] = True
    return window


def _distance_from_hull(mask: Mask) -> NDArray[np.float32]:
    hull = np.zeros(mask.shape, np.uint8)
    corners = cv2.convexHull(np.argwhere(mask)[:, ::-1].astype(np.int32))
    cv2.fillConvexPoly(hull, corners, 1)
    return cv2.distanceTransform(1 - hull, cv2.DIST_L2, 3)


def _histogram(lab: Lab, where: Mask) -> NDArray[np.float32]:
    counts = cv2.calcHist([lab], [0, 1, 2], where.astype(np.uint8), [_COLOUR_BINS] * 3, [0, 256] * 3)
    kernel = np.array([0.25, 0.5, 0.25], np.float32)
    for axis in range(3):
        moved = np.moveaxis(counts, axis, 0).reshape(_COLOUR_BINS, -1)
        blurred = cv2.sepFilter2D(moved, -1, np.ones(1, np.float32), kernel, borderType=cv2.BORDER_REPLICATE)
        counts = np.moveaxis(blurred.reshape(_COLOUR_BINS, _COLOUR_BINS, _COLOUR_BINS), 0, axis)
    return counts / max(1.0, float(counts.sum()))
