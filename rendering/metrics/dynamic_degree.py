"""How much a clip is seen to move."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import LEAST_FLOW_SIDE, as_uint8, optical_flow

__all__ = ["DynamicDegree", "strongest"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Share of the picture that moves most, in which the degree is measured.
_STRONGEST = 0.05


class DynamicDegree:
    """How much a clip is seen to move, whatever it was meant to do.

    Attributes:
        value: mean over the frames of the optical flow in the 5 % of the picture that move most [px/frame]; None
            before the second frame.
    """

    def __init__(self) -> None:
        self._previous: NDArray[np.uint8] | None = None
        self._degrees: list[float] = []

    def add(self, frame: FloatImage) -> None:
        grey = cv2.cvtColor(as_uint8(frame), cv2.COLOR_RGB2GRAY)
        if self._previous is not None and min(grey.shape) >= LEAST_FLOW_SIDE:
            self._degrees.append(strongest(optical_flow(self._previous, grey)))
        self._previous = grey

    @property
    def value(self) -> float | None:
        return float(np.mean(self._degrees)) if self._degrees else None


def strongest(flow: FloatImage) -> float:
    """Mean length of a flow in the 5 % of the picture that move most [px], flow of shape [h, w, 2]."""
    lengths = np.hypot(flow[..., 0], flow[..., 1]).ravel()
    count = max(1, round(_STRONGEST * lengths.size))
    return float(np.sort(np.partition(lengths, -count)[-count:]).mean())
