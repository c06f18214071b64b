"""Ways along a shape: the graph on which distances through the triangles are measured."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .triangle_mesh import TriangleMesh

if TYPE_CHECKING:
    from scipy.sparse import csr_array

__all__ = ["ways_along", "ways_from"]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int32]


def ways_along(positions: FloatArray, triangles: IndexArray) -> csr_array:
    """Lengths of all edges, and of the lines between the corners opposite each edge where these stay inside, [v, v].

    Args:
        positions: of the vertices, shape [v, 2].
        triangles: vertex indices, shape [t, 3].
    """
    from scipy.sparse import coo_array

    edges = np.concatenate([triangles[:, [1, 2]], triangles[:, [2, 0]], triangles[:, [0, 1]]])
    order = np.lexsort(np.sort(edges, axis=1).T)
    ends, corners = np.sort(edges, axis=1)[order], triangles.T.ravel()[order]
    shared = np.flatnonzero((ends[1:] == ends[:-1]).all(axis=1))
    a, b, c, d = ends[shared, 0], ends[shared, 1], corners[shared], corners[shared + 1]
    inside = _sides(positions, c, d, a) * _sides(positions, c, d, b) < 0
    pairs = np.concatenate([ends, np.column_stack([c, d])[inside]])
    pairs = np.unique(np.sort(pairs, axis=1), axis=0)
    lengths = np.linalg.norm(np.diff(positions[pairs], axis=1)[:, 0], axis=1)
    size = len(positions)
    return coo_array((lengths, pairs.T), shape=(size, size)).tocsr()


def ways_from(mesh: TriangleMesh, chosen: NDArray[np.bool_]) -> FloatArray:
    """How far along the shape each vertex is from the nearest of those chosen [px], infinite where none is, shape [v].

    Args:
        mesh: the shape.
        chosen: some of its vertices, shape [v].
    """
    if not chosen.any():
        return np.full(len(chosen), np.inf)
    from scipy.sparse.csgraph import dijkstra

    graph = ways_along(mesh.vertices, mesh.triangles)
    return np.asarray(dijkstra(graph, directed=False, indices=np.flatnonzero(chosen), min_only=True))


def _sides(positions: FloatArray, start: IndexArray, end: IndexArray, points: IndexArray) -> FloatArray:
    """Positive for points on one side of the lines from start to end and negative on the other."""
    along, offset = positions[end] - positions[start], positions[points] - positions[start]
    return along[:, 0] * offset[:, 1] - along[:, 1] * offset[:, 0]
