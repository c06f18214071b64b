"""How close the lines of a clip are to the sketches that drove it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....physics.errors import InvalidInputError
from ...metrics import chamfer_distance
from ...pictures import as_float
from ...sketch import extract_sketch
from .clip import ClipOfPicture
from .column import Column
from .weights import ColumnWeights

__all__ = ["SKETCH_ADHERENCE"]


class _Adherence:
    def __init__(self, clip: ClipOfPicture, weights: ColumnWeights) -> None:
        self._sketches: Iterator[NDArray[Any]] | None = None if clip.sketches is None else iter(clip.sketches)
        self._distances: list[float] = []

    def add(self, frame: NDArray[np.uint8]) -> None:
        if self._sketches is None:
            return
        sketch = next(self._sketches, None)
        if sketch is None:
            raise InvalidInputError(f"sketches must be one for each frame. Got: {len(self._distances)}")
        self._distances.append(chamfer_distance(extract_sketch(as_float(frame)), np.asarray(sketch)))

    def values(self) -> Mapping[str, float | None]:
        return {SKETCH_ADHERENCE.key: float(np.mean(self._distances)) if self._distances else None}


SKETCH_ADHERENCE = Column(
    "sketch_adherence",
    "Sketch adherence",
    "Mean Chamfer distance between the lines of the frames and the sketches that drove the clip; only for clips with"
    " sketches.",
    unit="px",
    better="lower",
    begin=_Adherence,
)
