"""Farthest-point sampling: few points that cover a set of many evenly, or more densely where it matters."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["farthest_points"]

FloatArray = NDArray[np.float64]


def farthest_points(points: FloatArray, count: int, *, weights: FloatArray | None = None) -> NDArray[np.int64]:
    """Choose points one by one, each where the weighted distance to those already chosen is largest.

    The choice depends on nothing else: equal input gives equal output, and of equal places the first is taken.

    Args:
        points: what to choose from, shape [n, 2].
        count: how many to choose; all of them when there are fewer.
        weights: factor on the distance of each point, above 0, shape [n]; a point of weight 2 is chosen as readily as
            one of weight 1 that lies twice as far from the others. None means 1 everywhere.

    Returns:
        Indices of the chosen points in the order of their choice, shape [min(count, n)].
    """
    weights = np.ones(len(points)) if weights is None else weights
    nearest = np.ones(len(points))  # the same everywhere: the weights alone decide on the first
    chosen: list[int] = []
    for _ in range(min(count, len(points))):
        score = weights * nearest
        score[chosen] = -1.0
        best = int(np.argmax(score))
        distance = np.hypot(*(points - points[best]).T)
        nearest = np.minimum(nearest, distance) if chosen else distance
        chosen.append(best)
    return np.array(chosen, dtype=np.int64)
