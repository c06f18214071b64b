"""The region of a picture in which a click lies, on clean line art as well as on paint, paper grain and noise.

On clean art a region is what small steps of colour reach. On paint such a flood stays within one touch of the brush,
and over a blurred edge it leaks. So the picture is looked at in several coarsenesses: each averages away the texture
below it. The finest look that does not leak is taken, unless the next one finds a region many times larger: then the
finer one had only found a speck of the texture.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from .noise import without_noise

__all__ = ["looks_at", "region_of_click"]

Mask = NDArray[np.bool_]
Lab = NDArray[np.uint8]

# A region that grows over more than this share of the picture has probably leaked: smaller steps are tried.
_LARGEST_REGION = 0.25
# Each look halves the last, so a texture as coarse as a pixel of the coarser one is seen whole in it: a region that
# grows by more than the area of a pixel does was bounded by texture, not by an edge.
_GROWTH = 4.0
_SHORTEST = 24
_LOOKS = 4
_NARROWEST, _WIDEST = 6, 24
"""Colour around the click in which a flood over a blurred edge is held [8-bit Lab]."""


def looks_at(lab: Lab) -> list[Lab]:
    """The picture, its half, its quarter and so on, each without noise that is left in it.

    Args:
        lab: 8-bit Lab, shape [h, w, 3].
    """
    looks = [cv2.bilateralFilter(lab, 5, 20, 3)]
    height, width = lab.shape[:2]
    for halvings in range(1, _LOOKS):
        size = (max(1, width >> halvings), max(1, height >> halvings))
        if min(size) < _SHORTEST:
            break
        looks.append(without_noise(cv2.resize(lab, size, interpolation=cv2.INTER_AREA)))
    return looks


def region_of_click(
    looks: Sequence[Lab], point: NDArray[np.int_], others: NDArray[np.int_], tolerance: int
) -> Mask:
    """The pixels that belong to a click; none where every flood runs into a point of the other kind.

    Args:
        looks: of ``looks_at``.
        point: column and row of the click.
        others: columns and rows of the points of the other kind, shape [k, 2].
        tolerance: how much colour may change from pixel to pixel [8-bit Lab steps].

    Returns:
        mask, shape [h, w] of the finest look.
    """
    height, width = looks[0].shape[:2]
    finest = _flooded(looks[0], point, others, tolerance)
    chosen, leaked = finest, finest.mean() >= _LARGEST_REGION
    for look in looks[1:]:
        ratio = np.array([look.shape[1] / width, look.shape[0] / height])
        for region in _candidates(look, (point * ratio).astype(int), (others * ratio).astype(int), tolerance):
            grown = cv2.resize(region.astype(np.uint8), (width, height), interpolation=cv2.INTER_NEAREST) > 0
            if not region.any() or region.mean() >= _LARGEST_REGION or grown[others[:, 1], others[:, 0]].any():
                continue
            if grown.sum() > _GROWTH * chosen.sum() or (leaked and grown.sum() > _GROWTH):
                chosen, leaked = grown, False
            break
    return chosen


def _candidates(look: Lab, point: NDArray[np.int_], others: NDArray[np.int_], tolerance: int) -> Iterator[Mask]:
    """What small steps reach near the click's own colour, and should that leak, nearer to it."""
    reached = _flooded(look, point, others, tolerance)
    for spread in range(_WIDEST, _NARROWEST - 1, -_NARROWEST):
        yield reached & _filled(look, point, spread, cv2.FLOODFILL_FIXED_RANGE)


def _flooded(look: Lab, point: NDArray[np.int_], others: NDArray[np.int_], tolerance: int) -> Mask:
    """Pixels reached from a point over small steps of colour, fewer if that runs into a point of the other kind."""
    for step in range(tolerance, 0, -1):
        region = _filled(look, point, step, 0)
        trusted = step == 1 or region.mean() < _LARGEST_REGION
        if trusted and not region[others[:, 1], others[:, 0]].any():
            return region
    return np.zeros(look.shape[:2], dtype=bool)


def _filled(look: Lab, point: NDArray[np.int_], step: int, mode: int) -> Mask:
    height, width = look.shape[:2]
    reached = np.zeros((height + 2, width + 2), np.uint8)
    flags = 4 | cv2.FLOODFILL_MASK_ONLY | (1 << 8) | mode
    cv2.floodFill(look, reached, (int(point[0]), int(point[1])), (0, 0, 0), (step,) * 3, (step,) * 3, flags)
    return reached[1:-1, 1:-1] > 0
