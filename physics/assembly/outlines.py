"""How far apart the points of colliders' outlines lie."""

from __future__ import annotations

import numpy as np

from ..mesh import boundary_edges
from ..scene import LEAST_SPACING, Scene
from .system import System

__all__ = ["outline_spacing"]


def outline_spacing(scene: Scene, system: System) -> float:
    """Distance of the points of colliders' outlines [px]: that of the bodies' boundary vertices."""
    edges = boundary_edges(system.rest.triangles)
    lengths = np.linalg.norm(np.diff(system.rest.positions[edges], axis=1)[:, 0], axis=1)
    return max(float(np.median(lengths)) * scene.bodies[0].mesh.longest_side, LEAST_SPACING)
