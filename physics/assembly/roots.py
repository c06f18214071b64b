"""Stiff roots and soft tips: how far along the shape each triangle is from where its part is held.

Hair is thick and lies close at its root, where many strands carry each other, and thin at its tip; cloth is sewn on and
ribbons are knotted. A body of one stiffness bends most where it is held, so that it leaves what it lies on.

The stiffness of a strip goes with the cube of its width, its weight with the width alone: pointed tips of one stiffness
curl up. A lock of hair is a bundle of fibres, which bends alike whether it has many or few, so thin tips are stiffer.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh import TriangleMesh, ways_from
from .widths import local_widths

__all__ = ["distances_from_root", "root_factors"]

FloatArray = NDArray[np.float64]

_SLENDEREST = 4.0  # how many times as thin as usual a place is, at most, for its stiffness


def distances_from_root(mesh: TriangleMesh, held: NDArray[np.bool_]) -> FloatArray:
    """How far along the shape each vertex is from what is held, 0 there and 1 at the farthest tip of its part: [v].

    Args:
        mesh: the shape.
        held: which vertices are held, shape [v]. In parts without any all distances are 1.
    """
    ways = ways_from(mesh, held)
    reached, parts = np.isfinite(ways), mesh.components
    farthest = np.zeros(int(parts.max()) + 1)
    np.maximum.at(farthest, parts[reached], ways[reached])
    return np.divide(ways, farthest[parts], out=np.ones(len(held)), where=reached & (farthest[parts] > 0))


def root_factors(mesh: TriangleMesh, held: NDArray[np.bool_], root_stiffness: float) -> FloatArray:
    """Factor on Young's modulus of each triangle, above 1 near the root and at thin tips, shape [t].

    Where a part is as wide as usual it is root_stiffness^(1 - distance from the root): 1 at the farthest tip.

    Args:
        mesh: the shape.
        held: which vertices are held, shape [v].
        root_stiffness: of the material; 1 leaves all as it is.
    """
    if root_stiffness == 1 or not held.any():
        return np.ones(len(mesh.triangles))
    distances = distances_from_root(mesh, held)[mesh.triangles].mean(axis=1)
    widths = local_widths(mesh)
    slender = np.clip(np.median(widths) / widths, 1, _SLENDEREST)
    return np.asarray(root_stiffness ** (1 - distances) * slender ** (2 * distances))
