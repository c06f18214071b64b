"""The outline of a mesh, and its vertices in an order in which those of the outline are first."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import half_edges, on_boundary

__all__ = ["outline_first", "outline_of"]

IndexArray = NDArray[np.int64]


def outline_of(rest: NDArray[np.floating], triangles: IndexArray) -> IndexArray:
    """The vertices around a mesh in turn; around its largest piece, where it has several.

    The two sides of a slit are parts of the outline. Holes are not.

    Args:
        rest: vertices, shape [v, 2].
        triangles: shape [t, 3].
    """
    sides = half_edges(triangles)
    # Not by their direction: where a mesh is folded, triangles that wind the same way go along an edge the same way.
    beside: dict[int, list[int]] = {}
    for one, other in sides[on_boundary(sides)].tolist():
        beside.setdefault(one, []).append(other)
        beside.setdefault(other, []).append(one)
    loops = []
    while beside:
        point = next(iter(beside))
        loop = []
        while point in beside:
            loop.append(point)
            following = beside[point].pop()
            beside[following].remove(point)
            for end in {point, following}:
                if not beside[end]:
                    del beside[end]
            point = following
        loops.append(loop)
    return np.array(max(loops, key=lambda loop: _area(rest[loop])), dtype=np.int64)


def outline_first(count: int, outline: IndexArray) -> IndexArray:
    """Numbers of all vertices, those of an outline first and in its order, each once, shape [count]."""
    _, first = np.unique(outline, return_index=True)
    hull = outline[np.sort(first)]
    return np.concatenate([hull, np.setdiff1d(np.arange(count), hull)])


def _area(points: NDArray[np.floating]) -> float:
    x, y = points.T
    return abs(float(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1))))
