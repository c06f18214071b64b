"""Query points: where somebody clicked to say which part of the picture is meant."""

from __future__ import annotations

from dataclasses import dataclass

from .errors import require
from .limits import LARGEST
from .points import Scale

__all__ = ["QueryPoint"]


@dataclass(frozen=True)
class QueryPoint:
    """A clicked point of a segmentation.

    Attributes:
        x: pixels from the left edge.
        y: pixels from the top edge.
        positive: true for a point on the wanted part, false for one beside it.
    """

    x: float
    y: float
    positive: bool = True

    def __post_init__(self) -> None:
        for name in ("x", "y"):
            value = getattr(self, name)
            require(name, value, -LARGEST <= value <= LARGEST, f"-{LARGEST} to {LARGEST} px")

    def rescaled(self, scale: Scale) -> QueryPoint:
        """The same point over the picture at another size."""
        return QueryPoint(self.x * scale[0], self.y * scale[1], self.positive)
