"""Contact: how bodies keep out of each other, and still shapes that they slide over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..checks import within
from ..errors import require
from ..points import Scale
from ..rig import MaskRegion, Polygon

__all__ = ["Collider", "Contact"]


@dataclass(frozen=True)
class Contact:
    """How bodies touch. Those that overlap as drawn keep their overlap, until they come apart.

    Attributes:
        friction: Coulomb's coefficient: 0 slides freely, 1 hardly slides.
        thickness: distance that bodies keep from each other [px]; half of it gives way under pressure.
        self_contact: whether a body also keeps out of itself, such as a curl that folds, and the separate parts of a
            body out of each other.

    Examples:
        >>> from physanimator.physics.scene import Contact
        >>> Contact(friction=0.5, self_contact=True).thickness
        1.5
    """

    friction: float = 0.3
    thickness: float = 1.5
    self_contact: bool = False

    def __post_init__(self) -> None:
        require("friction", self.friction, within(self.friction, 0, 1), "0 to 1")
        require("thickness", self.thickness, within(self.thickness, 0, 100, above=True), "above 0 and at most 100 px")
        given = isinstance(self.self_contact, bool)
        require("self_contact", self.self_contact, given, "True or False")

    def rescaled(self, scale: Scale) -> Contact:
        """The same contact over the picture at another size."""
        return Contact(self.friction, self.thickness * scale[2], self.self_contact)


@dataclass(frozen=True, eq=False)
class Collider:
    """Something in the picture that does not move and that bodies keep out of, such as a shoulder under hair.

    It acts where the scene has a ``Contact``.

    Attributes:
        region: its shape: a polygon, or a painted mask, which is stretched over the illustration.

    Examples:
        >>> from physanimator.physics.rig import Polygon
        >>> from physanimator.physics.scene import Collider
        >>> len(Collider(Polygon(((0, 50), (60, 50), (60, 60), (0, 60)))).region.points)
        4
    """

    region: Polygon | MaskRegion

    def __post_init__(self) -> None:
        shape = type(self.region).__name__
        require("region", shape, isinstance(self.region, Polygon | MaskRegion), "a polygon or a mask")

    @staticmethod
    def from_mask(mask: NDArray[np.bool_]) -> Collider:
        """The collider that a mask paints, bool, shape [h, w]."""
        return Collider(MaskRegion(mask))

    def rescaled(self, scale: Scale) -> Collider:
        """The same collider over the picture at another size."""
        return Collider(self.region.rescaled(scale))
