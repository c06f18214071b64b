"""How much a loop jumps where it begins again."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from .clip import ClipOfPicture
from .column import Column
from .weights import ColumnWeights

__all__ = ["LOOP_RESIDUAL"]

Picture = NDArray[np.uint8]


class _Residual:
    def __init__(self, clip: ClipOfPicture, weights: ColumnWeights) -> None:
        self._loops = clip.loops
        self._first: list[Picture] = []
        self._last: list[Picture] = []

    def add(self, frame: Picture) -> None:
        if self._loops:
            self._first = (self._first + [frame])[:2]
            self._last = (self._last + [frame])[-2:]

    def values(self) -> Mapping[str, float | None]:
        if len(self._first) < 2:
            return {LOOP_RESIDUAL.key: None}
        jump = _change(self._last[-1], self._first[0])
        beside = [_change(*self._first), _change(*self._last)]
        return {LOOP_RESIDUAL.key: max(0.0, jump - float(np.mean(beside)))}


def _change(one: Picture, other: Picture) -> float:
    return float(np.abs(one.astype(np.float32) - other).mean()) / 255


LOOP_RESIDUAL = Column(
    "loop_residual",
    "Loop residual",
    "Mean change of colour from the last frame to the first beyond that of the steps before and after it, 0 to 1;"
    " only for clips that loop.",
    better="lower",
    begin=_Residual,
)
