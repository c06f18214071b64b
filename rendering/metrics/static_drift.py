"""How much a clip changes where nothing should."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .flow_warp_error import RestMaps

__all__ = ["StaticDrift", "away_from", "still_region"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Outlines and soft edges reach this far out of a body [px].
_BESIDE = 4


class StaticDrift:
    """How much a clip changes where nothing should.

    Attributes:
        mean, worst: of the frames so far, 0..1; None where nothing is still.
    """

    def __init__(self, reference: FloatImage, still: Mask) -> None:
        """
        Args:
            reference: RGB 0..1, shape [h, w, 3].
            still: where nothing should change, shape [h, w].
        """
        self._reference, self._still, self._changes = reference, still, list[float]()

    def add(self, frame: FloatImage) -> None:
        if self._still.any():
            self._changes.append(float(np.abs(frame - self._reference)[self._still].mean()))

    @property
    def mean(self) -> float | None:
        return float(np.mean(self._changes)) if self._changes else None

    @property
    def worst(self) -> float | None:
        return max(self._changes, default=None)


def still_region(maps: RestMaps) -> Mask:
    """Where no body comes in any frame, nor its outline, shape [h, w]."""
    ever = maps.flow.inside.copy()
    for t in range(len(maps.flow)):
        ever |= maps.covered(t)
    return away_from(ever)


def away_from(moving: Mask) -> Mask:
    """Where no outline of something within a mask comes, shape [h, w]."""
    size = 2 * _BESIDE + 1
    return cv2.dilate(moving.astype(np.uint8), np.ones((size, size), np.uint8)) == 0
