"""How far points are from closed outlines, which are filled by the even-odd rule."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..interruption import checkpoint

__all__ = ["signed_distances", "within_reach"]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]

_PAIRS_AT_ONCE = 1 << 13  # of a point and an edge, each some 100 bytes: measured fastest, as they stay in the cache
_BANDS = 512
_POINTS_AT_ONCE = 64  # each may be near every edge


def signed_distances(points: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Distance of points from closed outlines, negative inside by the even-odd rule, shape [n].

    Args:
        points: shape [n, 2].
        starts: of the edges, shape [e, 2].
        ends: of the edges, shape [e, 2].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import signed_distances
        >>> corners = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
        >>> signed_distances(np.array([[5.0, 4.0], [13.0, 5.0]]), corners, np.roll(corners, -1, axis=0)).tolist()
        [-4.0, 3.0]
    """
    at_once = max(1, _PAIRS_AT_ONCE // max(len(starts), 1))
    distances = np.empty(len(points))
    for first in range(0, len(points), at_once):
        checkpoint()
        some = points[first : first + at_once]
        distance = _segment_distances(some, starts, ends)
        distances[first : first + at_once] = np.where(_crossed(some, starts, ends) % 2 == 1, -distance, distance)
    return distances


def within_reach(
    points: FloatArray, starts: FloatArray, ends: FloatArray, reach: float
) -> tuple[IndexArray, FloatArray]:
    """Which points lie inside closed outlines, by the even-odd rule, or nearer to them than a reach, and how far.

    Args:
        points: shape [n, 2].
        starts: of the edges, shape [e, 2].
        ends: of the edges, shape [e, 2].
        reach: above 0, in the same unit.

    Returns:
        Indices of points, ascending, and their distances from the outlines, negative inside, of equal length.
    """
    from scipy.spatial import cKDTree

    inside = _inside(points, starts, ends)
    middles, half = (starts + ends) / 2, float(np.hypot(*(ends - starts).T).max(initial=0.0)) / 2
    tree = cKDTree(middles)
    nearest, _ = tree.query(points)
    near = np.flatnonzero(inside | (nearest - half <= reach * (1 + 1e-9)))
    # The edge nearest to a point has its middle no farther away than the nearest middle and half the longest edge.
    farthest = (nearest[near] + half) * (1 + 1e-9) + 1e-12
    distances = np.empty(len(near))
    for first in range(0, len(near), _POINTS_AT_ONCE):
        checkpoint()
        some = slice(first, first + _POINTS_AT_ONCE)
        found = tree.query_ball_point(points[near[some]], farthest[some], return_sorted=False)
        counts = np.array([len(edges) for edges in found])
        edges, owners = np.concatenate(found).astype(np.int64), np.repeat(points[near[some]], counts, axis=0)
        square = _squares(*(owners - starts[edges]).T, *(ends - starts)[edges].T)
        distances[some] = np.sqrt(np.minimum.reduceat(square, np.cumsum(counts) - counts))
    distances = np.where(inside[near], -distances, distances)
    kept = distances < reach
    return near[kept], distances[kept]


def _crossed(points: FloatArray, starts: FloatArray, ends: FloatArray) -> IndexArray:
    """How many edges lie to the right of each point, shape [n]; odd inside of closed outlines."""
    edge_x, edge_y = (ends - starts).T
    x, y = points[:, :1] - starts[:, 0], points[:, 1:] - starts[:, 1]  # from the edges' starts, shape [n, e]
    spans = (y < 0) != (points[:, 1:] < ends[:, 1])
    along = np.divide(y, np.broadcast_to(edge_y, y.shape), out=np.zeros_like(y), where=spans)  # 0..1
    return (spans & (x < edge_x * along)).sum(axis=1)


def _segment_distances(points: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Distance of each point from the nearest of some edges, with every edge beside every point in memory."""
    x, y = points[:, :1] - starts[:, 0], points[:, 1:] - starts[:, 1]
    return np.asarray(np.sqrt(_squares(x, y, *(ends - starts).T).min(axis=1, initial=np.inf)))


def _squares(x: FloatArray, y: FloatArray, edge_x: FloatArray, edge_y: FloatArray) -> FloatArray:
    """Squared distances of points, seen from the starts of edges, from these edges."""
    t = np.clip((x * edge_x + y * edge_y) / np.maximum(edge_x**2 + edge_y**2, 1e-30), 0.0, 1.0)
    return np.asarray((x - t * edge_x) ** 2 + (y - t * edge_y) ** 2)


def _inside(points: FloatArray, starts: FloatArray, ends: FloatArray) -> NDArray[np.bool_]:
    """Whether each point is inside, band by band of y, so that each meets only edges at its height."""
    result = np.zeros(len(points), dtype=bool)
    lowest, highest = np.minimum(starts[:, 1], ends[:, 1]), np.maximum(starts[:, 1], ends[:, 1])
    order = np.argsort(points[:, 1], kind="stable")
    for some in np.array_split(order, min(_BANDS, max(1, len(order) // 8))):
        if not len(some):
            continue
        here = (lowest <= points[some[-1], 1]) & (highest >= points[some[0], 1])
        first, last = starts[here], ends[here]
        at_once = max(1, _PAIRS_AT_ONCE // max(len(first), 1))
        for begin in range(0, len(some), at_once):
            checkpoint()
            piece = some[begin : begin + at_once]
            result[piece] = _crossed(points[piece], first, last) % 2 == 1
    return result
