"""How much of a picture the moving parts have left."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ...metrics.metrics import hole_ratio
from .clip import ClipOfPicture
from .column import Column
from .weights import ColumnWeights

__all__ = ["HOLE_RATIO"]


class _Holes:
    def __init__(self, clip: ClipOfPicture, weights: ColumnWeights) -> None:
        self._clip = clip

    def add(self, frame: NDArray[np.uint8]) -> None:
        """The motion alone says it."""

    def values(self) -> Mapping[str, float | None]:
        return {HOLE_RATIO.key: None if self._clip.maps is None else hole_ratio(self._clip.maps)}


HOLE_RATIO = Column(
    "hole_ratio",
    "Hole ratio",
    "Mean share of the picture that the parts have left, of which the illustration shows nothing, 0 to 1; only for"
    " clips that follow a simulation.",
    begin=_Holes,
)
"""It says how much a method had to make up, not how well it did."""
