"""Paint: regions of the picture in which bodies are stiffer, heavier or more damped than their materials say."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..checks import is_whole, within
from ..errors import InvalidInputError, require
from ..limits import MAX_BODIES
from ..points import Scale
from ..rig import MaskRegion, Polygon

if TYPE_CHECKING:
    pass

__all__ = ["LEAST_FACTOR", "MOST_FACTOR", "QUANTITIES", "Paint"]

QUANTITIES = ("stiffness", "damping", "density")
LEAST_FACTOR, MOST_FACTOR = 0.001, 1_000


@dataclass(frozen=True)
class Paint:
    """Factors on the material of what lies in a region; a triangle that lies in it in part takes a part of them.

    Attributes:
        region: where, a polygon or a mask.
        stiffness: factor on Young's modulus, 0.001 to 1000; a body with a sway frequency still sways as often.
        damping: factor on the damping, 0.001 to 1000.
        density: factor on the density, 0.001 to 1000.
        body: number of the only body that it acts on; None for all.

    Examples:
        >>> from physanimator.physics.rig import Polygon
        >>> from physanimator.physics.scene import Paint
        >>> Paint(Polygon(((10, 10), (50, 10), (50, 20))), stiffness=4.0).damping
        1.0
    """

    region: Polygon | MaskRegion
    stiffness: float = 1.0
    damping: float = 1.0
    density: float = 1.0
    body: int | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.region, Polygon | MaskRegion):
            raise InvalidInputError(f"region must be a polygon or a mask. Got: {type(self.region).__name__}")
        for name in QUANTITIES:
            factor = getattr(self, name)
            require(name, factor, within(factor, LEAST_FACTOR, MOST_FACTOR), f"{LEAST_FACTOR} to {MOST_FACTOR}")
        require(
            "body",
            self.body,
            self.body is None or is_whole(self.body, 0, MAX_BODIES - 1),
            f"a body's number, 0 to {MAX_BODIES - 1}",
        )
        object.__setattr__(self, "body", None if self.body is None else int(self.body))

    def rescaled(self, scale: Scale) -> Paint:
        """The same over the picture at another size."""
        return replace(self, region=self.region.rescaled(scale))
