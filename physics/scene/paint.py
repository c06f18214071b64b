"""Paint: regions of the picture in which bodies are stiffer, heavier or more damped than their materials say."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from ..fields import Field, check_fields, described
from ..limits import LEAST_FACTOR, MOST_FACTOR
from ..points import Scale
from ..rig import BodyNumber
from .shapes import Shape, shape_field

__all__ = ["QUANTITIES", "Paint"]

QUANTITIES = ("stiffness", "damping", "density")


def _factor(title: str, about: str) -> Field:
    return Field(title, about, minimum=LEAST_FACTOR, maximum=MOST_FACTOR)


@described
@dataclass(frozen=True)
class Paint:
    """Factors on the material of what lies in a region; a triangle that lies in it in part takes a part of them.

    Examples:
        >>> from physanimator.physics.rig import Polygon
        >>> from physanimator.physics.scene import Paint
        >>> Paint(Polygon(((10, 10), (50, 10), (50, 20))), stiffness=4.0).damping
        1.0
    """

    region: Annotated[Shape, shape_field("Where: a polygon or a painted mask.")]
    stiffness: Annotated[
        float,
        _factor("Stiffness", "Factor on the stiffness there. A body with a sway frequency still sways as often."),
    ] = 1.0
    damping: Annotated[float, _factor("Damping", "Factor on the damping there.")] = 1.0
    density: Annotated[float, _factor("Density", "Factor on the density there.")] = 1.0
    body: BodyNumber = None

    def __post_init__(self) -> None:
        check_fields(self)

    def rescaled(self, scale: Scale) -> Paint:
        """The same over the picture at another size."""
        return replace(self, region=self.region.rescaled(scale))
