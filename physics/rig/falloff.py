"""Soft edges of regions: outside its region a rig point still pulls vertices along, the less the farther they are.

A vertex at distance d feels the acceleration k (x_led - x) + 2 sqrt(k) (v_led - v) with k = (FIRMNESS g)^2 and the grip
g = 1 - d / falloff: a critically damped spring to where the rig point would lead it. The kernels take the spring at the
end of the step, so that it is stable at any step and grip.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..mesh import TriangleMesh
from .regions import coarseness_of, distances_of
from .rig_point import RigPoint

__all__ = ["FIRMNESS", "grip_at", "grips_of"]

FIRMNESS = 2 * math.pi * 10
"""Angular frequency of the spring at the region's edge [1/s]: well above any sway, so that it follows closely there."""

_NARROWEST = 1e-6  # [px]: nothing overflows when divided by it


def grips_of(
    rig_points: Sequence[RigPoint], mesh: TriangleMesh, *, body: int = 0
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """How firmly each vertex is pulled along, and by which rig point.

    Where several reach a vertex the firmest pulls it, of equals the later.

    Args:
        rig_points: all rig points of the scene.
        mesh: the body's mesh.
        body: the body's number; rig points of other bodies are passed over.

    Returns:
        Grip g, 0..1, shape [v], and the index of the rig point, int32, -1 where there is none, shape [v].
    """
    grips, grippers = np.zeros(len(mesh.vertices)), np.full(len(mesh.vertices), -1, dtype=np.int32)
    coarse = coarseness_of(rig_points)
    for index, rig_point in enumerate(rig_points):
        if rig_point.falloff > 0 and rig_point.body in (None, body):
            grip = grip_at(distances_of(rig_point, mesh, coarse=coarse), rig_point.falloff)
            firmer = (grip > 0) & (grip >= grips)
            grips[firmer], grippers[firmer] = grip[firmer], index
    return grips, grippers


def grip_at(distances: NDArray[np.float64], falloff: float) -> NDArray[np.float64]:
    """Grip g at distances from a region whose pull fades out within a falloff [px], 0..1, shape [n]."""
    return np.clip(1 - distances / max(falloff, _NARROWEST), 0.0, 1.0)
