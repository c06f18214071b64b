"""What the optical flow that is seen in a clip says, so that it can be told of any clip: its error and its speed."""

from __future__ import annotations

from collections.abc import Mapping

import cv2
import numpy as np
from numpy.typing import NDArray

from ...metrics.dynamic_degree import strongest
from ...pictures import LEAST_FLOW_SIDE, as_float, optical_flow
from .clip import ClipOfPicture
from .column import Column
from .weights import ColumnWeights

__all__ = ["DYNAMIC_DEGREE", "FLOW_WARP_ERROR"]

Flow = NDArray[np.float32]
FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]


class _SeenFlow:
    """Both columns have the same flow, which takes most of the time."""

    def __init__(self, clip: ClipOfPicture, weights: ColumnWeights) -> None:
        self._rate = clip.rate
        self._previous: NDArray[np.uint8] | None = None
        self._errors: list[float] = []
        self._degrees: list[float] = []

    def add(self, frame: NDArray[np.uint8]) -> None:
        if self._previous is not None and min(frame.shape[:2]) >= LEAST_FLOW_SIDE:
            grey = [cv2.cvtColor(each, cv2.COLOR_RGB2GRAY) for each in (self._previous, frame)]
            forth, back = optical_flow(*grey), optical_flow(*grey[::-1])
            self._degrees.append(strongest(forth))
            self._errors += _error(self._previous, frame, forth, back)
        self._previous = frame

    def values(self) -> Mapping[str, float | None]:
        return {
            FLOW_WARP_ERROR.key: float(np.mean(self._errors)) if self._errors else None,
            DYNAMIC_DEGREE.key: self._rate * float(np.mean(self._degrees)) if self._degrees else None,
        }


def _error(first: NDArray[np.uint8], second: NDArray[np.uint8], forth: Flow, back: Flow) -> list[float]:
    """Mean change of colour of the points that are seen in both frames; none where there is no such point."""
    height, width = first.shape[:2]
    places = forth + np.dstack(np.meshgrid(np.arange(width, dtype=np.float32), np.arange(height, dtype=np.float32)))
    seen = _seen(forth, _at(back, places))
    x, y = places[..., 0], places[..., 1]
    seen &= (x >= 0) & (x <= width - 1) & (y >= 0) & (y <= height - 1)
    changes = np.abs(_at(as_float(second), places) - as_float(first))
    return [float(changes[seen].mean())] if seen.any() else []


def _seen(forth: Flow, back: Flow) -> Mask:
    """Where a point is not hidden in the other frame nor at an edge of the flow.

    Ruder et al., "Artistic style transfer for videos" (2016), whose bounds Lai et al. use.
    """
    lengths, there_and_back = _squared(forth), _squared(forth + back)
    slopes = sum(np.gradient(forth[..., axis], axis=along) ** 2 for axis in (0, 1) for along in (0, 1))
    consistent = there_and_back <= 0.01 * (lengths + _squared(back)) + 0.5
    return np.asarray(consistent & (slopes <= 0.01 * lengths + 0.002))


def _squared(flow: Flow) -> FloatImage:
    """Lengths times themselves, shape [h, w]."""
    return flow[..., 0] ** 2 + flow[..., 1] ** 2


def _at(picture: FloatImage, places: Flow) -> FloatImage:
    """Bilinear values at places, shape as they are."""
    return cv2.remap(picture, places[..., 0], places[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


FLOW_WARP_ERROR = Column(
    "flow_warp_error",
    "Flow-warp error (optical flow)",
    "Mean change of colour from frame to frame, followed along the optical flow that is seen (dense inverse search),"
    " 0 to 1; a clip that stands still has none.",
    better="lower",
    begin=_SeenFlow,
)
"""Lai et al., "Learning blind video temporal consistency" (ECCV 2018), with the mean absolute difference. The same flow
finder looks at every clip, since an error along an exact flow does not compare with one along an estimated flow."""

DYNAMIC_DEGREE = Column(
    "dynamic_degree",
    "Dynamic degree",
    "Mean speed of what moves most, 5 % of the picture, by the optical flow that is seen (dense inverse search).",
    unit="px/s",
    begin=_SeenFlow,
)
"""A second's motion, not a frame's, so that clips of different frame rates compare. More is not better: shaking and
flicker move, too."""
