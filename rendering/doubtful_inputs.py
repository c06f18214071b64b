"""Sentences about masks that repeat each other, and about a plate of another picture."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from .pictures import as_uint8, over

__all__ = ["doubts_about_plate", "repeated_masks"]

_LOOKED_AT = 512  # longest side at which is looked [px]
_SAME = 0.9  # of what two masks cover together both cover: they are one part
# A plate differs from the picture by more than the first, beside the parts, on more than the second of it: it shows
# something else. Repainted and compressed plates stay far below [8-bit levels].
_LEVELS, _SHARE = 40, 0.5
_AROUND = 9  # what is this near to a part may belong to it [px]


def repeated_masks(masks: Sequence[NDArray[Any]]) -> list[str]:
    """A sentence for each two masks that are nearly the same.

    Args:
        masks: of the parts, 0 to 1, shape [h, w] each.
    """
    shown = [_small(mask) > 0.5 for mask in masks]
    told = []
    for (first, one), (second, other) in combinations(enumerate(shown), 2):
        both, either = np.count_nonzero(one & other), np.count_nonzero(one | other)
        if either and both >= _SAME * either:
            told.append(f"bodies[{second}]: the mask covers what that of part {first + 1} does: is it given twice?")
    return told


def doubts_about_plate(image: NDArray[Any], plate: NDArray[Any] | None, masks: Sequence[NDArray[Any]]) -> list[str]:
    """A sentence about a plate that is not the picture where nothing moves.

    Args:
        image: RGB or RGBA, shape [h, w, c].
        plate: the picture without its parts, of the same size; None where it is painted in.
        masks: of the parts, 0 to 1, shape [h, w] each.
    """
    if plate is None:
        return []
    moving = np.logical_or.reduce([_small(mask) > 0.1 for mask in masks]).astype(np.uint8)
    beside = cv2.dilate(moving, np.ones((_AROUND, _AROUND), np.uint8)) == 0
    if not beside.any():
        return []
    picture, behind = (_small(as_uint8(over(each))).astype(np.int16) for each in (image, plate))
    share = float((np.abs(picture - behind).max(axis=2) > _LEVELS)[beside].mean())
    if share <= _SHARE:
        return []
    return [
        f"the plate differs from the picture on {100 * share:.0f} % of what does not move: is it the same picture"
        " without the moving parts?"
    ]


def _small(plane: NDArray[Any]) -> NDArray[Any]:
    scale = min(1.0, _LOOKED_AT / max(plane.shape[:2]))
    size = max(1, round(plane.shape[1] * scale)), max(1, round(plane.shape[0] * scale))
    values = plane if plane.dtype == np.uint8 else np.asarray(plane, np.float32)
    return cv2.resize(values, size, interpolation=cv2.INTER_AREA)
