"""How wide a shape is around each of its triangles: the largest disc inside it that holds the place."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..mesh import TriangleMesh

__all__ = ["local_widths"]

FloatArray = NDArray[np.float64]

_ACROSS = 512  # cells along the longer side of the shape
_LEVEL = 1.25  # from one radius that is tried to the next


def local_widths(mesh: TriangleMesh) -> FloatArray:
    """Width around each triangle within a quarter, at least a five-hundredth of the shape [px], shape [t].

    Source: Hildebrand and Rüegsegger, "A new method for the model-independent assessment of thickness in
    three-dimensional images" (1997), here with discs of some radii only.
    """
    corner, span = mesh.vertices.min(axis=0), np.ptp(mesh.vertices, axis=0)
    scale = _ACROSS / float(span.max())
    shape = np.zeros(np.ceil(span[::-1] * scale).astype(int) + 3, dtype=np.uint8)
    fixed = np.rint(((mesh.vertices - corner) * scale + 1) * 16).astype(np.int32)
    for triangle in fixed[mesh.triangles]:
        cv2.fillConvexPoly(shape, triangle, 1, shift=4)
    room, radius = _distances(shape), 1.0
    radii = np.full(shape.shape, radius, dtype=np.float32)
    while radius < room.max():
        outside = (room < radius).astype(np.uint8)
        radii[_distances(outside) <= radius] = radius
        radius *= _LEVEL
    column, row = np.rint((mesh.vertices[mesh.triangles].mean(axis=1) - corner) * scale + 1).astype(int).T
    return 2 * radii[row, column].astype(np.float64) / scale


def _distances(shape: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Distance of each cell from the nearest one that is zero within 2 %, shape [h, w]."""
    return np.asarray(cv2.distanceTransform(shape, cv2.DIST_L2, cv2.DIST_MASK_5), dtype=np.float32)
