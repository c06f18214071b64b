"""Bodies whose materials are painted: the paint of a scene laid on the meshes that it covers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray

from ..interruption import checkpoint
from ..material import mask_means, painted_by_means
from ..mesh import TriangleMesh
from ..rig import MaskRegion, Polygon
from ..scene import QUANTITIES, Body, Paint

__all__ = ["with_paint"]

_LARGEST_MASK = 2_048  # [px]: a polygon is filled at most so finely, which is well below any triangle


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
