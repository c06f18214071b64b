"""Tethers: threads from where a body is held to each of its free points, which make it look inextensible.

They are the long range attachments of Kim, Chentanez and Müller-Fischer, "Long Range Attachments - A Method to Simulate
Inextensible Clothing in Computer Games" (2012): a strand of soft triangles stretches under a strong wind, and stiff
ones would need many small steps; a thread of fixed length costs nothing and does not hinder bending.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..material import RestShape
from ..mesh import ways_along

__all__ = ["tethers"]

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
        ways_along(drawn.positions, drawn.triangles[wanted[drawn.triangles[:, 0]]]),
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
