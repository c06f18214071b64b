"""Query points: where somebody clicked to say which part of the picture is meant."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..checks import is_whole, within
from ..errors import require
from ..limits import LARGEST, MAX_PARTS
from ..points import Scale

__all__ = ["QueryPoint"]


@dataclass(frozen=True)
class QueryPoint:
    """A clicked point of a segmentation.

    Attributes:
        x: pixels from the left edge.
        y: pixels from the top edge.
        positive: true for a point on the wanted part, false for one beside it.
        part: number of the part that is meant, from 0, where several are cut out at once.
    """

    x: float
    y: float
    positive: bool = True
    part: int = 0

    def __post_init__(self) -> None:
        for name in ("x", "y"):
            value = getattr(self, name)
            require(name, value, within(value, -LARGEST, LARGEST), f"-{LARGEST} to {LARGEST} px")
        require("part", self.part, is_whole(self.part, 0, MAX_PARTS - 1), f"0 to {MAX_PARTS - 1}")
        object.__setattr__(self, "part", int(self.part))

    def rescaled(self, scale: Scale) -> QueryPoint:
        """The same point over the picture at another size."""
        return replace(self, x=self.x * scale[0], y=self.y * scale[1])
