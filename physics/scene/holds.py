"""What rig points hold of the bodies of a scene: every region is compared with the vertices of all bodies, once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import SimulationError
from ..rig import EDGE, Points, Polygon, RigPoint, coarseness_of, distances_of, grip_at, vertices_of
from .scene import Body, Scene

__all__ = ["Holds", "holds_of", "region_work"]

_MOST_WORK = 1e10  # corners of polygons times vertices: some minutes


@dataclass(frozen=True, eq=False)
class Holds:
    """Which vertices rig points lead or pull, one array for each body.

    Attributes:
        leaders: index of the rig point that leads each vertex, -1 where it is free, int32, each of shape [v].
        grips: how firmly a rig point pulls it along that does not lead it, 0..1, each of shape [v].
        grippers: index of that rig point, -1 where there is none, int32, each of shape [v].
    """

    leaders: tuple[NDArray[np.int32], ...]
    grips: tuple[NDArray[np.float64], ...]
    grippers: tuple[NDArray[np.int32], ...]


def holds_of(scene: Scene) -> Holds:
    """What the rig points of a scene hold, as ``regions.leaders_of`` and ``falloff.grips_of`` tell it for one body.

    Raises:
        SimulationError: the polygons have so many corners that comparing them with the meshes would take minutes.
    """
    work = region_work(scene.rig_points, scene.bodies)
    if work > _MOST_WORK:
        raise SimulationError(
            f"The polygons of all rig points must have fewer corners, or the meshes fewer vertices: at most"
            f" {_MOST_WORK:g} comparisons are allowed. Got: {work:.3g}"
        )
    vertices = np.concatenate([body.mesh.vertices for body in scene.bodies])
    starts = np.cumsum([0] + [len(body.mesh.vertices) for body in scene.bodies])
    leaders, grippers = (np.full(len(vertices), -1, dtype=np.int32) for _ in range(2))
    grips, coarse = np.zeros(len(vertices)), coarseness_of(scene.rig_points)
    for index, rig_point in enumerate(scene.rig_points):
        first, last = (0, len(scene.bodies)) if rig_point.body is None else (rig_point.body, rig_point.body + 1)
        own = slice(starts[first], starts[last])
        points = Points(vertices[own], scene.width, scene.height)
        if rig_point.falloff > 0:
            distances = distances_of(rig_point, points, coarse=coarse)
            grip = grip_at(distances, rig_point.falloff)
            firmer = (grip > 0) & (grip >= grips[own])
            grips[own][firmer], grippers[own][firmer] = grip[firmer], index
            inside = distances <= EDGE if isinstance(rig_point.region, Polygon) else vertices_of(rig_point, points)
        else:
            inside = vertices_of(rig_point, points)
        leaders[own][inside] = index
    cut = starts[1:-1]
    return Holds(*(tuple(np.split(array, cut)) for array in (leaders, grips, grippers)))  # type: ignore[arg-type]


def region_work(rig_points: Sequence[RigPoint], bodies: Sequence[Body]) -> int:
    """Corners of all polygons times the vertices that each is compared with."""
    counts = [len(body.mesh.vertices) for body in bodies]
    work = 0
    for point in rig_points:
        if isinstance(point.region, Polygon):
            work += len(point.region.points) * (sum(counts) if point.body is None else counts[point.body])
    return work
