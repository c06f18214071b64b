"""Sentences about parts whose masks end within one colour: a piece of them tears off when they move."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..physics.mesh import TriangleMesh
from ..physics.rig import Pinned, RigPoint, leaders_of
from ..physics.scene import Scene
from .matting import OpenEdge

__all__ = ["edge_advice", "edges_in_words"]

_NAMED = 3
_SHARE = 0.5  # so much of an edge is held where nothing is said of it


def edge_advice(edges: Sequence[Sequence[OpenEdge]], scene: Scene) -> list[str]:
    """A sentence for each body of which a piece stays behind where it moves.

    Args:
        edges: where each body ends within one colour, where that is known; where it is pinned does not matter.
        scene: the bodies, and what holds them.
    """
    told = []
    for number, (body, found) in enumerate(zip(scene.bodies, edges, strict=False)):
        pinned = _pinned(scene.rig_points, body.mesh, number) if found else np.zeros(0, bool)
        moving = [each for each in found if _held(each.points, body.mesh, pinned) <= _SHARE]
        named = f" ({body.name})" if body.name else ""
        told += [f"bodies[{number}]{named}: {each}" for each in edges_in_words(moving)]
    return told


def edges_in_words(edges: Sequence[OpenEdge], *, of: str = "its mask") -> list[str]:
    """One sentence about where a mask ends within one colour; none without edges.

    Args:
        edges: longest first.
        of: what the mask is called.
    """
    if not edges:
        return []
    middles = [(each, each.points[len(each.points) // 2]) for each in edges[:_NAMED]]
    places = ", ".join(f"({x:.0f}, {y:.0f}) for {each.length:.0f} px" for each, (x, y) in middles)
    more = "" if len(edges) <= _NAMED else " and so on"
    return [
        f"{of} ends within one colour, where no line is drawn, at {places}{more}: what lies beyond stays behind and"
        " tears off when the part moves. Extend the mask to the next line or edge there, or pin the part there"
    ]


def _pinned(rig_points: Sequence[RigPoint], mesh: TriangleMesh, number: int) -> NDArray[np.bool_]:
    """Which vertices are held where they were drawn, shape [n]."""
    leaders = leaders_of(rig_points, mesh, body=number)
    still = np.array([isinstance(each.motion, Pinned) for each in rig_points] + [False])
    return still[leaders]


def _held(points: NDArray[np.float32], mesh: TriangleMesh, pinned: NDArray[np.bool_]) -> float:
    """The share of points whose nearest vertex is pinned."""
    from scipy.spatial import cKDTree

    return float(pinned[cKDTree(mesh.vertices).query(points)[1]].mean())
