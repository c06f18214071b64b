"""Query points: where somebody clicked to say which part of the picture is meant."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from ..fields import Field, check_fields, described
from ..limits import MAX_PARTS
from ..points import Scale

__all__ = ["QueryPoint"]


@described
@dataclass(frozen=True)
class QueryPoint:
    """A clicked point of a segmentation."""

    x: Annotated[float, Field("x", "From the left edge of the illustration.", "px")]
    y: Annotated[float, Field("y", "From the top edge of the illustration.", "px")]
    positive: Annotated[bool, Field("Positive", "true on the wanted part, false beside it.")] = True
    part: Annotated[
        int,
        Field(
            "Part",
            "Number of the part that is meant, from 0, where several are cut out at once.",
            minimum=0,
            maximum=MAX_PARTS - 1,
        ),
    ] = 0

    def __post_init__(self) -> None:
        check_fields(self)

    def rescaled(self, scale: Scale) -> QueryPoint:
        """The same point over the picture at another size."""
        return replace(self, x=self.x * scale[0], y=self.y * scale[1])
