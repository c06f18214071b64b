"""The boundary of a triangulation."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

__all__ = ["boundary_edges", "half_edges", "on_boundary"]

Int32Array = NDArray[np.int32]
Whole = TypeVar("Whole", bound="np.integer[Any]")


def boundary_edges(triangles: Int32Array) -> Int32Array:
    """The edges that belong to one triangle alone, each in the direction in which its triangle has it, shape [e, 2].

    Args:
        triangles: indices of vertices, shape [t, 3].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import boundary_edges
        >>> boundary_edges(np.array([[0, 1, 2], [0, 2, 3]], np.int32)).tolist()
        [[0, 1], [1, 2], [2, 3], [3, 0]]
    """
    half = half_edges(triangles)
    return half[on_boundary(half)]


def half_edges(triangles: NDArray[Whole]) -> NDArray[Whole]:
    """The sides of all triangles, first to second corner, then second to third, then third to first, shape [3 t, 2]."""
    return np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])


def on_boundary(half: NDArray[np.integer]) -> NDArray[np.bool_]:
    """Which half-edges belong to one triangle alone, shape [3 t]."""
    low, high = half.min(axis=1).astype(np.int64), half.max(axis=1)
    _, inverse, counts = np.unique(low << 32 | high, return_inverse=True, return_counts=True)
    return np.asarray(counts[inverse] == 1)
