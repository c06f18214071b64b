"""Tethers: threads from where a body is held to each of its free points, which make it look inextensible.

They are the long range attachments of Kim, Chentanez and Müller-Fischer, "Long Range Attachments - A Method to Simulate
Inextensible Clothing in Computer Games" (2012): a strand of soft triangles stretches under a strong wind, and stiff
ones would need many small steps; a thread of fixed length costs nothing and does not hinder bending.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..material import RestShape

if TYPE_CHECKING:
    from scipy.sparse import csr_array

__all__ = ["tethers"]

IndexArray = NDArray[np.int32]

_STRAIGHT = 1.06
"""A way along edges that is at most so many times as long as the straight line may stand for the line itself."""


def tethers(
    drawn: RestShape, held: NDArray[np.bool_], limits: NDArray[np.float64]
) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """The held vertex that is nearest to each free one, by the way through the triangles, and the thread to it.

    Args:
        drawn: the triangles as they were drawn [side].
        held: vertices that are held or led, shape [v].
        limits: how many times as long as the way a vertex's thread is, infinite for no thread, shape [v].

    Returns:
        The anchor of each vertex, -1 where it has none, shape [v], and the length of its thread [side], 0 without one.
    """
    anchors, lengths = np.full(len(held), -1, dtype=np.int32), np.zeros(len(held))
    wanted = np.isfinite(limits)
    if not (wanted & held).any() or not (wanted & ~held).any():
        return anchors, lengths
    from scipy.sparse.csgraph import dijkstra

    ways, _, sources = dijkstra(
        _ways(drawn, wanted),
        directed=False,
        indices=np.flatnonzero(wanted & held),
        min_only=True,
        return_predecessors=True,
    )
    found = np.isfinite(ways) & wanted & ~held
    anchors[found] = sources[found]
    straight = np.linalg.norm(drawn.positions[found] - drawn.positions[anchors[found]], axis=1)
    lengths[found] = limits[found] * np.where(ways[found] <= _STRAIGHT * straight, straight, ways[found])
    return anchors, lengths


def _ways(drawn: RestShape, wanted: NDArray[np.bool_]) -> csr_array:
    """Lengths of all edges, and of the lines between the corners opposite each edge where these stay inside, [v, v]."""
    from scipy.sparse import coo_array

    triangles = drawn.triangles[wanted[drawn.triangles[:, 0]]]
    edges = np.concatenate([triangles[:, [1, 2]], triangles[:, [2, 0]], triangles[:, [0, 1]]])
    order = np.lexsort(np.sort(edges, axis=1).T)
    ends, corners = np.sort(edges, axis=1)[order], triangles.T.ravel()[order]
    shared = np.flatnonzero((ends[1:] == ends[:-1]).all(axis=1))
    a, b, c, d = ends[shared, 0], ends[shared, 1], corners[shared], corners[shared + 1]
    inside = _sides(drawn, c, d, a) * _sides(drawn, c, d, b) < 0
    pairs = np.concatenate([ends, np.column_stack([c, d])[inside]])
    pairs = np.unique(np.sort(pairs, axis=1), axis=0)
    lengths = np.linalg.norm(np.diff(drawn.positions[pairs], axis=1)[:, 0], axis=1)
    size = len(drawn.positions)
    return coo_array((lengths, pairs.T), shape=(size, size)).tocsr()


def _sides(drawn: RestShape, start: IndexArray, end: IndexArray, points: IndexArray) -> NDArray[np.float64]:
    """Positive for points on one side of the lines from start to end and negative on the other."""
    along, offset = drawn.positions[end] - drawn.positions[start], drawn.positions[points] - drawn.positions[start]
    return along[:, 0] * offset[:, 1] - along[:, 1] * offset[:, 0]
