"""Flow-warp error along the flow that is seen in a clip, so that it can be told of any clip."""

from __future__ import annotations

from collections.abc import Mapping

import cv2
import numpy as np
from numpy.typing import NDArray

from ...pictures import LEAST_FLOW_SIDE, as_float, optical_flow
from .clip import ClipOfPicture
from .column import Column
from .weights import ColumnWeights

__all__ = ["FLOW_WARP_ERROR"]

Flow = NDArray[np.float32]
FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]


class _Error:
    def __init__(self, clip: ClipOfPicture, weights: ColumnWeights) -> None:
        self._previous: NDArray[np.uint8] | None = None
        self._errors: list[float] = []

    def add(self, frame: NDArray[np.uint8]) -> None:
        if self._previous is not None and min(frame.shape[:2]) >= LEAST_FLOW_SIDE:
            self._errors += _error(self._previous, frame)
        self._previous = frame

    def values(self) -> Mapping[str, float | None]:
        return {FLOW_WARP_ERROR.key: float(np.mean(self._errors)) if self._errors else None}


def _error(first: NDArray[np.uint8], second: NDArray[np.uint8]) -> list[float]:
    """Mean change of colour of the points that are seen in both frames; none where there is no such point."""
    grey = [cv2.cvtColor(each, cv2.COLOR_RGB2GRAY) for each in (first, second)]
    forth, back = optical_flow(*grey), optical_flow(*grey[::-1])
    height, width = grey[0].shape
    places = forth + np.dstack(np.meshgrid(np.arange(width, dtype=np.float32), np.arange(height, dtype=np.float32)))
    seen = _seen(forth, _at(back, places))
    seen &= (places >= 0).all(axis=2) & (places[..., 0] <= width - 1) & (places[..., 1] <= height - 1)
    changes = np.abs(_at(as_float(second), places) - as_float(first))
    return [float(changes[seen].mean())] if seen.any() else []


def _seen(forth: Flow, back: Flow) -> Mask:
    """Where a point is not hidden in the other frame nor at an edge of the flow.

    Ruder et al., "Artistic style transfer for videos" (2016), whose bounds Lai et al. use.
    """
    lengths = (forth**2).sum(axis=2)
    there_and_back = ((forth + back) ** 2).sum(axis=2)
    slopes = sum(np.gradient(forth[..., axis], axis=along) ** 2 for axis in (0, 1) for along in (0, 1))
    consistent = there_and_back <= 0.01 * (lengths + (back**2).sum(axis=2)) + 0.5
    return np.asarray(consistent & (slopes <= 0.01 * lengths + 0.002))


def _at(picture: FloatImage, places: Flow) -> FloatImage:
    """Bilinear values at places, shape as they are."""
    return cv2.remap(picture, places[..., 0], places[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


FLOW_WARP_ERROR = Column(
    "flow_warp_error",
    "Flow-warp error (optical flow)",
    "Mean change of colour from frame to frame, followed along the optical flow that is seen (dense inverse search),"
    " 0 to 1; a clip that stands still has none.",
    better="lower",
    begin=_Error,
)
"""Lai et al., "Learning blind video temporal consistency" (ECCV 2018), with the mean absolute difference. The same flow
finder looks at every clip, since an error along an exact flow does not compare with one along an estimated flow."""
