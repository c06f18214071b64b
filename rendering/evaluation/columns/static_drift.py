"""How much a clip changes where nothing should, against the illustration."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ...metrics.static_drift import StaticDrift
from ...pictures import as_float
from .clip import ClipOfPicture
from .column import Column
from .weights import ColumnWeights

__all__ = ["STATIC_DRIFT"]


class _Drift:
    def __init__(self, clip: ClipOfPicture, weights: ColumnWeights) -> None:
        still = clip.still
        self._drift = None if still is None else StaticDrift(as_float(clip.picture), still)

    def add(self, frame: NDArray[np.uint8]) -> None:
        if self._drift is not None:
            self._drift.add(as_float(frame))

    def values(self) -> Mapping[str, float | None]:
        return {STATIC_DRIFT.key: None if self._drift is None else self._drift.mean}


STATIC_DRIFT = Column(
    "static_drift",
    "Static drift",
    "Mean change of colour against the illustration where no part ever comes, 0 to 1.",
    better="lower",
    begin=_Drift,
)
