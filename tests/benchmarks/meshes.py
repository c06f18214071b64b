"""Meshes of about a wanted size."""

from __future__ import annotations

import numpy as np
import source_tree  # noqa: F401
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask

__all__ = ["SIDE2_OVER_AREA", "mesh_of_about"]

SIDE2_OVER_AREA = 2.31
"""Squared side of an equilateral triangle over its area: 4 / sqrt 3."""


def mesh_of_about(mask: np.ndarray, triangles: int) -> TriangleMesh:
    """Mesh whose spacing is chosen so that it has about so many triangles."""
    spacing = float(np.sqrt(mask.sum() * SIDE2_OVER_AREA / triangles))
    for _ in range(4):
        mesh = mesh_from_mask(mask, spacing=spacing)
        spacing *= float(np.sqrt(len(mesh.triangles) / triangles))
    return mesh
