"""Contact: how bodies keep out of each other, and still shapes that they slide over."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from ..fields import Field, Input, check_fields, described
from ..mesh import refuse_noise
from ..points import Scale
from ..rig import MaskRegion
from .shapes import LayerRegion, Shape, shape_field

__all__ = ["Collider", "Contact"]


@described
@dataclass(frozen=True)
class Contact:
    """How bodies touch. Those that overlap as drawn keep their overlap, until they come apart.

    Friction is Coulomb's coefficient. Half of the thickness gives way under pressure.

    Examples:
        >>> from physanimator.physics.scene import Contact
        >>> Contact(friction=0.5, self_contact=True).thickness
        1.5
    """

    friction: Annotated[
        float,
        Field("Friction", "0 slides freely, 1 hardly slides.", minimum=0, maximum=1),
        Input("Friction [1]: 0 slides freely, 1 hardly slides.", step=0.05),
    ] = 0.3
    thickness: Annotated[
        float,
        Field(
            "Thickness",
            "Distance that bodies keep from each other. What is nearer as drawn keeps the distance it has.",
            "px",
            above=0,
            maximum=100,
        ),
        Input("Distance that bodies keep from each other [px]; what is nearer as drawn stays as near.", 0.1, step=0.1),
    ] = 1.5
    self_contact: Annotated[
        bool,
        Field("Self-contact", "Whether a body also keeps out of itself, and its separate parts out of each other."),
        Input("Whether a body also keeps out of itself, such as a curl that folds."),
    ] = False

    def __post_init__(self) -> None:
        check_fields(self)

    def rescaled(self, scale: Scale) -> Contact:
        """The same contact over the picture at another size."""
        return Contact(self.friction, self.thickness * scale[2], self.self_contact)


@described
@dataclass(frozen=True, eq=False)
class Collider:
    """Something in the picture that does not move and that bodies keep out of, such as a shoulder under hair.

    It acts where the scene has a ``Contact``.

    Examples:
        >>> from physanimator.physics.rig import Polygon
        >>> from physanimator.physics.scene import Collider
        >>> len(Collider(Polygon(((0, 50), (60, 50), (60, 60), (0, 60)))).region.points)
        4
    """

    region: Annotated[
        Shape, shape_field("The shape: a polygon, a painted mask, or what is drawn on a layer of the artwork.")
    ]

    def __post_init__(self) -> None:
        check_fields(self)

    @staticmethod
    def from_mask(mask: NDArray[np.bool_], *, layer: str = "") -> Collider:
        """The collider that a mask paints.

        Args:
            mask: bool, shape [h, w].
            layer: name of the layer that it shows; empty where it shows none.

        Raises:
            MeshingError: the mask is noise, whose outlines would take minutes.
        """
        refuse_noise(np.asarray(mask, dtype=np.float32))
        return Collider(LayerRegion(mask, layer) if layer else MaskRegion(mask))

    def rescaled(self, scale: Scale) -> Collider:
        """The same collider over the picture at another size."""
        return Collider(self.region.rescaled(scale))
