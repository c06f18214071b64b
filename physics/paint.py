"""Paint: regions of the picture in which bodies are stiffer, heavier or more damped than their materials say."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from .checks import is_whole, within
from .errors import InvalidInputError, require
from .interruption import checkpoint
from .limits import MAX_BODIES
from .painting import mask_means, painted_by_means
from .points import Scale
from .rig import MaskRegion, Polygon

if TYPE_CHECKING:
    from .mesh import TriangleMesh
    from .scene import Body

__all__ = ["LEAST_FACTOR", "MOST_FACTOR", "QUANTITIES", "Paint", "with_paint"]

QUANTITIES = ("stiffness", "damping", "density")
LEAST_FACTOR, MOST_FACTOR = 0.001, 1_000
_LARGEST_MASK = 2_048  # [px]: a polygon is filled at most so finely, which is well below any triangle


@dataclass(frozen=True)
class Paint:
    """Factors on the material of what lies in a region; a triangle that lies in it in part takes a part of them.

    Attributes:
        region: where, a polygon or a mask.
        stiffness: factor on Young's modulus, 0.001 to 1000; a body with a sway frequency still sways as often.
        damping: factor on the damping, 0.001 to 1000.
        density: factor on the density, 0.001 to 1000.
        body: number of the only body that it acts on; None for all.
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


def with_paint(bodies: Sequence[Body], paint: Sequence[Paint]) -> tuple[Body, ...]:
    """The bodies with the paint on their materials, one entry over the other.

    Raises:
        InvalidInputError: painting over painting has come to a factor that is out of bounds.
    """
    result = list(bodies)
    for entry in paint:
        factors = {name: (1.0, getattr(entry, name)) for name in QUANTITIES if getattr(entry, name) != 1.0}
        numbers = [number for number in range(len(result)) if entry.body in (None, number)]
        if not factors or not numbers:
            continue
        mask = _mask(entry.region, result[0].mesh)  # all bodies are over one picture
        for number in numbers:
            checkpoint()
            body = result[number]
            material = painted_by_means(body.material, mask_means(mask, body.mesh), factors)
            result[number] = replace(body, material=material)
    return tuple(result)


def _mask(region: Polygon | MaskRegion, mesh: TriangleMesh) -> NDArray[np.bool_]:
    """The region as a mask to be stretched over the picture; pixels on the edge of a polygon belong to it."""
    if isinstance(region, MaskRegion):
        return region.mask
    scale = min(1.0, _LARGEST_MASK / mesh.longest_side)
    size = max(1, round(mesh.height * scale)), max(1, round(mesh.width * scale))
    factors = np.array([size[1] / mesh.width, size[0] / mesh.height])
    corners = np.rint((np.array(region.points) * factors - 0.5) * 16).clip(-(2**27), 2**27).astype(np.int32)
    filled = np.zeros(size, dtype=np.uint8)
    cv2.fillPoly(filled, [corners], 1, shift=4)
    return filled.view(bool)
