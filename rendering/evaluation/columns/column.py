"""What a column of the report is."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from .clip import ClipOfPicture
from .statistics import Summary
from .weights import ColumnWeights

__all__ = ["Column", "Measurement", "Missing"]


class Measurement(Protocol):
    """Is fed the frames of a clip one after the other, and then says the values of its columns by their keys."""

    def add(self, frame: NDArray[np.uint8]) -> None: ...

    def values(self) -> Mapping[str, float | None]: ...


Begin = Callable[[ClipOfPicture, ColumnWeights], Measurement]
Compare = Callable[[Iterable[ClipOfPicture], ColumnWeights], Summary | None]


@dataclass(frozen=True)
class Column:
    """A measure of clips, or of all clips of a method together.

    Attributes:
        key: name in files.
        title: what stands above the column.
        meaning: one sentence on what it measures.
        unit: of the values; empty for none.
        better: which way is better; None where neither is.
        begin: starts a clip's measurement; columns with the same one are measured together. For values of a method,
            None.
        compare: the value of all clips of a method; None for values of a clip.
        weights: the keys of the weights that it needs.
    """

    key: str
    title: str
    meaning: str
    unit: str = ""
    better: Literal["lower", "higher"] | None = None
    begin: Begin | None = None
    compare: Compare | None = None
    weights: tuple[str, ...] = ()

    @property
    def of(self) -> Literal["clip", "method"]:
        """Whether each clip has a value, or only all clips of a method together."""
        return "method" if self.begin is None else "clip"


@dataclass(frozen=True)
class Missing:
    """Why a column is empty: weights that are not there.

    Attributes:
        name: usual name of the file or folder.
        sentence: what is wanted, and where to get it.
    """

    name: str
    sentence: str
