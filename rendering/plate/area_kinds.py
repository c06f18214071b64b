"""Which flat areas beside a hole go on behind it: not gradients, texture, or narrow strips along it."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["ending_at_edges", "glimpses", "wide_areas"]

FloatImage = NDArray[np.float32]
IntImage = NDArray[np.int32]
Mask = NDArray[np.bool_]

# Lines and the soft edges beside them are this wide [px].
_LINE = 5
# Areas end at edges along this share of their border, as far as it is within so many pixels of the hole: there colours
# change by more than this within so many [px].
_MOSTLY = 0.5
_AROUND = 32.0
_STEP = 0.08
_EDGE = 5
# What is flat for less than this share, in more parts than these, is texture.
_PLAIN = 0.65
_MANY = 6
# Areas in which this fits nowhere are thin [px].
_DISC = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (7, 7))
# A narrow area is a glimpse of a wide one if its mean colour is within the range of that one, and this beyond it.
_NEARLY = 0.02
# What is too narrow to be seen to be flat is of an area within so many squares of this side [px] whose colour differs
# by less than this, if it has so many pixels.
_SQUARES, _SQUARE = 8, 4
_SAME = 0.008
_SEEN = 12


def ending_at_edges(picture: FloatImage, hole: Mask, flat: Mask, labels: IntImage) -> IntImage:
    """New numbers: 0 for areas that end where colours begin to change faster, and not at edges."""
    square = np.ones((_EDGE,) * 2, np.uint8)
    away = cv2.distanceTransform((~hole).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    near = (away > _EDGE / 2) & (away < _AROUND)
    steep = (cv2.dilate(picture, square) - cv2.erode(picture, square)).max(axis=2) > _STEP
    # Borders lie in the middle of lines, edges at their sides.
    edge = cv2.dilate(steep.astype(np.uint8), np.ones((_LINE,) * 2, np.uint8))
    count = int(labels.max()) + 1
    length, edges = np.zeros(count), np.zeros(count)
    for one, other in ((np.s_[:, 1:], np.s_[:, :-1]), (np.s_[1:], np.s_[:-1])):
        border = near[one] & (labels[one] != labels[other])
        for side in (one, other):
            length += np.bincount(labels[side][border], minlength=count)
            edges += np.bincount(labels[side][border], weights=edge[one][border], minlength=count)
    kept = (edges >= _MOSTLY * length) & (np.arange(count) > 0) & ~_texture(labels, flat, near, count)
    numbers = np.zeros(count, dtype=np.int32)
    numbers[kept] = np.arange(1, kept.sum() + 1)
    return numbers


def _texture(labels: IntImage, flat: Mask, near: Mask, count: int) -> Mask:
    """Which areas are many small ones of one colour, with as much between them: bricks are no flat wall."""
    size = np.bincount(labels[near], minlength=count)
    even = np.bincount(labels[near], weights=flat[near], minlength=count)
    found = np.zeros(count, dtype=bool)
    for k in np.flatnonzero(even < _PLAIN * size):
        found[k] = cv2.connectedComponents((flat & near & (labels == k)).astype(np.uint8))[0] > _MANY
    return found


def wide_areas(picture: FloatImage, seeds: IntImage, labels: IntImage, hole: Mask) -> Mask:
    """Where areas are wider than lines and the light along edges, which run along a hole and not on behind it.

    A narrow area in the colours of a wide one is a glimpse of that.
    """
    areas = np.zeros(int(seeds.max()) + 1, dtype=bool)
    own = [seeds == k for k in range(len(areas))]
    for k in range(1, len(areas)):
        areas[k] = cv2.erode(own[k].astype(np.uint8), _DISC).any()
    narrow = [k for k in range(1, len(areas)) if not areas[k] and own[k].any()]
    if narrow:
        ranges = [(picture[own[k]].min(axis=0), picture[own[k]].max(axis=0)) for k in np.flatnonzero(areas)]
        for k in narrow:
            mean = picture[own[k]].mean(axis=0)
            areas[k] = any((mean > low - _NEARLY).all() and (mean < high + _NEARLY).all() for low, high in ranges)
    rest = cv2.morphologyEx(((labels == 0) & ~hole).astype(np.uint8), cv2.MORPH_OPEN, _DISC)
    return areas[labels] | ((labels == 0) & (cv2.dilate(rest, np.ones((5, 5), np.uint8)) > 0))


def glimpses(picture: FloatImage, where: Mask, areas: IntImage, known: tuple[FloatImage, IntImage]) -> IntImage:
    """Which area narrow gaps show, by its colour: its number, shape [h, w]; 0 where none.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        where: what is smooth beside the hole and not flat, shape [h, w].
        areas: numbers of the areas where they are known, from 1, shape [h, w]; 0 elsewhere.
        known: the colours of areas, RGB, shape [k, 3], and their numbers, shape [k].
    """
    row, column = np.nonzero(where)
    own, square = cv2.blur(picture, (3, 3))[row, column], (row // _SQUARE, column // _SQUARE)
    disc = np.ones((2 * _SQUARES + 1,) * 2, np.uint8)
    best, least = np.zeros(len(own), dtype=np.int32), np.full(len(own), _SAME, dtype=np.float32)
    for colour, number in zip(*known, strict=True):
        apart = np.linalg.norm(own - colour, axis=1)
        if (apart < least).any():
            near = cv2.dilate((areas[::_SQUARE, ::_SQUARE] == number).astype(np.uint8), disc) > 0
            nearer = near[square] & (apart < least)
            best[nearer], least[nearer] = number, apart[nearer]
    found = np.zeros(where.shape, dtype=np.int32)
    found[row, column] = best
    _, parts, stats, _ = cv2.connectedComponentsWithStats((found > 0).astype(np.uint8), connectivity=4)
    return np.where(stats[parts, cv2.CC_STAT_AREA] >= _SEEN, found, 0)
