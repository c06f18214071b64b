"""Clicks that hit a speck: they stand for what is close by.

Nobody clicks to the pixel. Where the region of a click is a few pixels, such as the glint of a lock, the crossing of
two lines or one dot of a pattern, the part that was meant lies beside it.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .clicked_regions import Looks, is_backdrop

__all__ = ["REACH", "off_specks"]

Lab = NDArray[np.uint8]
Points = NDArray[np.int_]

_SPECK = 40
"""A region of fewer pixels is a speck [px^2 of the size at which clicks are weighed]."""
_RADII = (2, 3, 4, 6, 8)
"""Distances at which to look for more, as far as a hand may miss [px of that size]."""
REACH = 8 / 640
"""The largest of them, as a share of the picture's longer side."""
_DIRECTIONS = 8
_LARGEST = 0.25  # of the picture: what is larger has most likely leaked
_ALIKE = (30, 12, 12)
"""By which light and shade change one colour, more on the specks of a part than on its areas [8-bit Lab]."""


def off_specks(lab: Lab, at: Points, positive: NDArray[np.bool_], tolerance: int) -> Points:
    """The points, with each point on the object that hits a speck moved to a region close by.

    It moves to the nearest region of its own hue, or else to the nearest at all; to none that is backdrop or holds a
    point beside the object. A point that finds no such region stays.

    Args:
        lab: 8-bit Lab, shape [h, w, 3].
        at: column and row of each point, shape [k, 2].
        positive: whether each point is on the object, shape [k].
        tolerance: how much colour may change from pixel to pixel within one region [8-bit Lab steps].

    Returns:
        columns and rows, shape [k, 2].
    """
    looks, others, moved = Looks(lab), at[~positive], at.copy()
    for index in np.flatnonzero(positive):
        if looks.region(at[index], others, tolerance).sum() < _SPECK:
            moved[index] = _beside(lab, looks, at[index], others, tolerance)
    return moved


def _beside(lab: Lab, looks: Looks, point: Points, others: Points, tolerance: int) -> Points:
    around = cv2.medianBlur(lab, 3)[point[1], point[0]].astype(np.float64)
    nearest = None
    for place in _ring(point, lab.shape[:2]):
        region = looks.region(place, others, tolerance)
        if region.sum() < _SPECK or region.mean() >= _LARGEST or is_backdrop(region):
            continue
        if (np.abs(np.median(lab[region].astype(np.float64), axis=0) - around) <= _ALIKE).all():
            return place
        nearest = place if nearest is None else nearest
    return point if nearest is None else nearest


def _ring(point: Points, size: tuple[int, ...]) -> list[Points]:
    """Places around a point in the picture, the nearest first."""
    angles = np.arange(_DIRECTIONS) * 2 * np.pi / _DIRECTIONS
    steps = np.concatenate([np.rint(radius * np.stack([np.cos(angles), np.sin(angles)], 1)) for radius in _RADII])
    places = point + steps.astype(int)
    return list(places[((places >= 0) & (places < size[::-1])).all(axis=1)])
