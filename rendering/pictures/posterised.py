"""Soft masks of few greys, which look like maps of labels."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["is_gradient", "is_posterised"]

Steps = NDArray[np.int16]

# Greys closer than this are one: noise, as JPEG makes it [8-bit levels].
_APART = 4
# Of all neighbours of two greys so many differ by one step; labels lie on black and beside any other label.
_ONE_STEP = 0.8
# More greys than this, each in the one before, are no accident.
_NESTED = 8
# With fewer, those between are nowhere farther from their edge than this share of the size of what is painted.
_NARROW = 0.08
# The middle half of a band's widths lies within this share of their median; parts have other shapes.
_PARALLEL = 0.35
# The medians of all bands lie within this factor of each other, of bands that lie on black beside each other the other.
_ALIKE, _SAME = 2.5, 1.5
_CROSS = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))


def is_posterised(plane: NDArray[np.float32]) -> bool:
    """Whether a plane of few greys is a smooth transition in steps, as a soft mask of few greys is.

    Args:
        plane: 0 to 1, shape [h, w].
    """
    steps, count = _steps_of(plane)
    if count < 3 or _share_of_single(steps) < _ONE_STEP:
        return False
    between = [(steps == number).astype(np.uint8) for number in range(1, count - 1)]
    widest = max(float(cv2.distanceTransform(each, cv2.DIST_L2, cv2.DIST_MASK_5).max()) for each in between)
    return count > _NESTED or widest <= _NARROW * float(np.sqrt(np.count_nonzero(steps)))


def is_gradient(plane: NDArray[np.float32]) -> bool:
    """Whether a plane of few greys shows them as bands of about one width, as a slow gradient in few steps does.

    Labels that lie side by side in order, as stripes of one width, look the same.

    Args:
        plane: 0 to 1, shape [h, w].
    """
    steps, count = _steps_of(plane)
    if count < 4:
        return False
    if _share_of_single(steps) >= _ONE_STEP:
        return _in_bands(steps, range(1, count - 1), _ALIKE)
    # A part that fades only inside of a hard outline lies on black with all of its greys.
    if _share_of_single(steps, painted=True) < _ONE_STEP:
        return False
    return count > 2 * _NESTED or _in_bands(steps, range(2, count - 1), _SAME)


def _steps_of(plane: NDArray[np.float32]) -> tuple[Steps, int]:
    """The number of each pixel's grey, from dark to bright, and how many there are; 0 where there are many."""
    levels = np.rint(plane * 255).astype(np.uint8)
    greys = np.unique(levels)
    firsts = greys[np.diff(greys, prepend=np.int16(-_APART)) >= _APART]
    if _spread(greys, firsts) >= 3 * _APART:
        return np.zeros(plane.shape, np.int16), 0
    return (np.searchsorted(firsts, levels, side="right") - 1).astype(np.int16), len(firsts)


def _spread(greys: NDArray[np.uint8], firsts: NDArray[np.uint8]) -> int:
    """The greatest difference of greys that are one."""
    lasts = [int(greys[greys < first].max()) for first in firsts[1:]]
    return max(last - int(first) for first, last in zip(firsts, [*lasts, int(greys[-1])], strict=True))


def _share_of_single(steps: Steps, *, painted: bool = False) -> float:
    """Of all neighbours of two greys, how many differ by one step; painted: those of black do not count."""
    changes = []
    for one, other in ((steps[1:], steps[:-1]), (steps[:, 1:], steps[:, :-1])):
        counted = (one != other) & (np.minimum(one, other) > 0) if painted else one != other
        changes.append(np.abs(one - other)[counted])
    found = np.concatenate(changes)
    return np.count_nonzero(found == 1) / max(1, len(found))


def _in_bands(steps: Steps, numbers: range, alike: float) -> bool:
    """Whether some greys, two at least, are bands whose borders are parallel, with widths within a factor."""
    middles: list[float] = []
    for number in numbers:
        band, brighter = steps == number, steps > number
        rim = band & (cv2.dilate((steps == number - 1).astype(np.uint8), _CROSS) > 0)
        if not rim.any():
            return False
        away = cv2.distanceTransform((~brighter).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)[rim]
        low, middle, high = np.percentile(away, (25, 50, 75))
        if high - low > _PARALLEL * middle:
            return False
        middles.append(float(middle))
    return len(middles) > 1 and max(middles) <= alike * min(middles)
