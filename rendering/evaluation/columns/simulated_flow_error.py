"""Flow-warp error along the simulation's own flow."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ...metrics.flow_warp_error import FlowWarpError
from ...pictures import as_float
from .clip import ClipOfPicture
from .column import Column
from .weights import ColumnWeights

__all__ = ["SIMULATED_FLOW_ERROR"]


class _Error:
    def __init__(self, clip: ClipOfPicture, weights: ColumnWeights) -> None:
        self._error = None if clip.maps is None else FlowWarpError(clip.maps)

    def add(self, frame: NDArray[np.uint8]) -> None:
        if self._error is not None:
            self._error.add(as_float(frame))

    def values(self) -> Mapping[str, float | None]:
        return {SIMULATED_FLOW_ERROR.key: None if self._error is None else self._error.to_previous}


SIMULATED_FLOW_ERROR = Column(
    "simulated_flow_error",
    "Flow-warp error (simulated flow)",
    "Mean change of colour from frame to frame on the moving parts, followed along the simulation's own flow, 0 to 1;"
    " only for clips that follow a simulation.",
    better="lower",
    begin=_Error,
)
