"""Slits in a mesh: its two sides share their places at rest, but no vertices, so that they part and overlap."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .boundary import half_edges
from .triangle_mesh import TriangleMesh

if TYPE_CHECKING:
    from scipy.sparse import coo_array

__all__ = ["cut_along"]

IndexArray = NDArray[np.int64]


def cut_along(mesh: TriangleMesh, edges: NDArray[np.integer]) -> TriangleMesh:
    """A mesh slit along edges. A vertex on them becomes as many as the edges part its triangles into.

    Vertices keep their numbers; those that are added come last.

    Args:
        mesh: the mesh.
        edges: vertex numbers, shape [e, 2].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import TriangleMesh, cut_along
        >>> square = TriangleMesh([[0, 0], [4, 0], [4, 4], [0, 4]], [[0, 1, 2], [0, 2, 3]], width=4, height=4)
        >>> slit = cut_along(square, np.array([[0, 2]]))
        >>> len(slit.vertices), int(slit.components.max()) + 1
        (6, 2)
    """
    from scipy.sparse.csgraph import connected_components

    corners = mesh.triangles.astype(np.int64).ravel()
    _, label = connected_components(_joined_corners(mesh.triangles, edges), directed=False)
    fan, first = np.unique(label, return_index=True)
    owner = corners[first]
    order = np.lexsort((first, owner))
    repeated = np.concatenate([[False], np.diff(owner[order]) == 0])
    number = np.empty(len(fan), dtype=np.int64)
    number[order[~repeated]] = owner[order[~repeated]]
    number[order[repeated]] = len(mesh.vertices) + np.arange(repeated.sum())
    vertices = np.concatenate([mesh.vertices, mesh.vertices[owner[order[repeated]]]])
    triangles = number[np.searchsorted(fan, label)].reshape(-1, 3)
    return TriangleMesh(vertices, triangles.astype(np.int32), mesh.width, mesh.height)


def _joined_corners(triangles: NDArray[np.int32], cuts: NDArray[np.integer]) -> coo_array:
    """Which corners of triangles are the same vertex: those on either side of an edge that is not cut, [3 t, 3 t]."""
    from scipy.sparse import coo_array

    count = len(triangles)
    half = half_edges(triangles).astype(np.int64)
    at = np.arange(count) * 3
    starts, ends = np.concatenate([at, at + 1, at + 2]), np.concatenate([at + 1, at + 2, at])
    low, high = half.min(axis=1), half.max(axis=1)
    turned = half[:, 0] != low
    starts, ends = np.where(turned, ends, starts), np.where(turned, starts, ends)
    key = low << 32 | high
    order = np.argsort(key, kind="stable")
    cut = np.sort(np.asarray(cuts, dtype=np.int64).reshape(-1, 2), axis=1)
    same = (key[order][1:] == key[order][:-1]) & ~np.isin(key[order][1:], cut[:, 0] << 32 | cut[:, 1])
    one, other = order[:-1][same], order[1:][same]
    pairs = np.concatenate([np.stack([starts[one], starts[other]]), np.stack([ends[one], ends[other]])], axis=1)
    return coo_array((np.ones(pairs.shape[1]), tuple(pairs)), shape=(3 * count, 3 * count))
