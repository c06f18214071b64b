"""How fast a clip is seen to move."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ...metrics.dynamic_degree import DynamicDegree
from ...pictures import as_float
from .clip import ClipOfPicture
from .column import Column
from .weights import ColumnWeights

__all__ = ["DYNAMIC_DEGREE"]


class _Degree:
    def __init__(self, clip: ClipOfPicture, weights: ColumnWeights) -> None:
        self._degree, self._rate = DynamicDegree(), clip.rate

    def add(self, frame: NDArray[np.uint8]) -> None:
        self._degree.add(as_float(frame))

    def values(self) -> Mapping[str, float | None]:
        value = self._degree.value
        return {DYNAMIC_DEGREE.key: None if value is None else value * self._rate}


DYNAMIC_DEGREE = Column(
    "dynamic_degree",
    "Dynamic degree",
    "Mean speed of what moves most, 5 % of the picture, by the optical flow that is seen (dense inverse search).",
    unit="px/s",
    begin=_Degree,
)
"""A second's motion, not a frame's, so that clips of different frame rates compare. More is not better: shaking and
flicker move, too."""
