"""Rigging: which vertices follow a rig point, and where it leads them.

Paper, Appendix "Details of Interactive Animation": the region follows the rig point's motion rigidly. How it turns
and is squashed meanwhile stands in ``leading``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..interruption import checkpoint
from ..mesh import TriangleMesh, signed_distances
from .easing import eased, eased_rate
from .rig_point import Circle, Combined, KeyedPath, MaskRegion, Polygon, RigMotion, RigPoint, Wave

__all__ = [
    "EDGE",
    "Points",
    "coarseness_of",
    "displacement",
    "distances_of",
    "leaders_of",
    "velocity",
    "vertices_of",
]

FloatArray = NDArray[np.float64]

EDGE = 1e-6
"""Vertices that rounding puts this far outside a region still lie on its edge [px]."""


_ROWS_AT_ONCE = 64
_PIXELS_OF_DISTANCES = 2**24  # of a scene's masks: of more, distances are measured on coarser ones


class Points(NamedTuple):
    """Points over a picture, such as the vertices of several meshes.

    Attributes:
        vertices: [px], shape [v, 2].
        width: of the picture [px].
        height: of the picture [px].
    """

    vertices: FloatArray
    width: int
    height: int

    @property
    def longest_side(self) -> float:
        """Length of the picture's longer side [px]."""
        return float(max(self.width, self.height))


def vertices_of(rig_point: RigPoint, mesh: TriangleMesh | Points) -> NDArray[np.bool_]:
    """Whether each vertex of a mesh lies in a rig point's region, the region's edge included.

    A polygon is filled by the even-odd rule. A mask of another size than the mesh's picture is stretched over it;
    vertices outside the picture follow the mask's nearest pixel.

    Returns:
        bool, shape [v].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.rig import Circle, RigPoint, vertices_of
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> bool(vertices_of(RigPoint((30, 30), Circle(60)), mesh).all())
        True
    """
    region = rig_point.region
    if isinstance(region, Circle):
        return _outside_circle(rig_point.position, region.radius, mesh.vertices) <= EDGE
    if isinstance(region, Polygon):
        return _outside_polygon(region.points, mesh.vertices) <= EDGE
    return _in_mask(region.mask, mesh)


def coarseness_of(rig_points: Sequence[RigPoint]) -> int:
    """How many pixels of masks, each way, are taken together for distances from the regions of all these rig points."""
    masks = [point.region.mask for point in rig_points if isinstance(point.region, MaskRegion) and point.falloff > 0]
    return max(1, math.ceil(math.sqrt(sum(mask.size for mask in masks) / _PIXELS_OF_DISTANCES)))


def distances_of(rig_point: RigPoint, mesh: TriangleMesh | Points, *, coarse: int | None = None) -> FloatArray:
    """How far outside a rig point's region each vertex of a mesh lies [px], 0 or less inside, shape [v].

    The distance from a mask is good to about a pixel of the mask, where pixels are taken together to about one of
    these.

    Args:
        rig_point: whose region it is.
        mesh: whose vertices they are.
        coarse: pixels of a mask that are taken together each way, as ``coarseness_of`` finds it for the rig points of
            a scene; None: as for this one alone.
    """
    region = rig_point.region
    if isinstance(region, Circle):
        return _outside_circle(rig_point.position, region.radius, mesh.vertices)
    if isinstance(region, Polygon):
        return _outside_polygon(region.points, mesh.vertices)
    return _outside_mask(region.mask, mesh, coarse or coarseness_of([replace(rig_point, falloff=1.0)]))


def leaders_of(rig_points: Sequence[RigPoint], mesh: TriangleMesh, *, body: int = 0) -> NDArray[np.int32]:
    """Index of the rig point that leads each vertex of a body, -1 where the vertex is free.

    Where several rig points select a vertex, the later one wins.

    Args:
        rig_points: all rig points of the scene.
        mesh: the body's mesh.
        body: the body's number; rig points of other bodies are passed over.

    Returns:
        int32, shape [v].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.rig import Circle, RigPoint, leaders_of
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> np.unique(leaders_of([RigPoint((10, 10), Circle(5))], mesh)).tolist()
        [-1, 0]
    """
    leaders = np.full(len(mesh.vertices), -1, dtype=np.int32)
    for index, rig_point in enumerate(rig_points):
        if rig_point.body is None or rig_point.body == body:
            leaders[vertices_of(rig_point, mesh)] = index
    return leaders


def displacement(motion: RigMotion, t: ArrayLike) -> FloatArray:
    """How far a motion has led its rig point from where it was drawn.

    Args:
        motion: pinned stays, and so does what only turns or squashes; a keyed path runs from key to key as its easing
            says, relative to the first; a wave swings as amplitude sin(2 pi t / period) direction; the ways of
            combined motions add up.
        t: time [s], a number or shape [n].

    Returns:
        [px], shape [2] or [n, 2].

    Examples:
        >>> from physanimator.physics.rig import Wave, displacement
        >>> displacement(Wave(amplitude=20.0, period=2.0, direction=(1.0, 0.0)), 0.5).round(6).tolist()
        [20.0, 0.0]
    """
    times = np.asarray(t, dtype=np.float64)
    if isinstance(motion, Combined):
        return np.sum([displacement(single, times) for single in motion.motions], axis=0)
    if isinstance(motion, Wave):
        start = np.radians(motion.phase)
        swing = motion.amplitude * (np.sin(2 * np.pi * times / motion.period + start) - np.sin(start))
        return swing[..., None] * np.array(motion.direction)
    if isinstance(motion, KeyedPath):
        return eased(motion.times, motion.points, motion.easing, times) - np.array(motion.points[0])
    return np.zeros((*times.shape, 2))


def velocity(motion: RigMotion, t: ArrayLike) -> FloatArray:
    """The time derivative of ``displacement``.

    A keyed path rests before its first key and from its last key on.

    Args:
        motion: the motion.
        t: time [s], a number or shape [n].

    Returns:
        [px/s], shape [2] or [n, 2].
    """
    times = np.asarray(t, dtype=np.float64)
    if isinstance(motion, Combined):
        return np.sum([velocity(single, times) for single in motion.motions], axis=0)
    if isinstance(motion, Wave):
        rate = 2 * np.pi / motion.period
        swing = motion.amplitude * rate * np.cos(rate * times + np.radians(motion.phase))
        return swing[..., None] * np.array(motion.direction)
    if isinstance(motion, KeyedPath):
        return eased_rate(motion.times, motion.points, motion.easing, times)
    return np.zeros((*times.shape, 2))


def _outside_circle(centre: tuple[float, float], radius: float, points: FloatArray) -> FloatArray:
    """Distance of each point from a disc's edge [px], negative inside, shape [n]."""
    return np.hypot(points[:, 0] - centre[0], points[:, 1] - centre[1]) - radius


def _outside_polygon(corners: Sequence[tuple[float, float]], points: FloatArray) -> FloatArray:
    """Distance of each point from a polygon filled by the even-odd rule [px], 0 inside, shape [n]."""
    starts = np.array(corners)
    return np.maximum(signed_distances(points, starts, np.roll(starts, -1, axis=0)), 0.0)


def _in_mask(mask: NDArray[np.bool_], mesh: TriangleMesh | Points) -> NDArray[np.bool_]:
    """Whether each vertex lies in a painted pixel or on its edge, shape [v]."""
    size = np.array([mask.shape[1], mask.shape[0]])
    scaled = mesh.vertices * (size / [mesh.width, mesh.height])
    low = np.clip(np.floor(scaled - EDGE), 0, size - 1).astype(np.int64)
    high = np.clip(np.floor(scaled + EDGE), 0, size - 1).astype(np.int64)
    return np.logical_or.reduce([mask[y[:, 1], x[:, 0]] for x in (low, high) for y in (low, high)])


def _outside_mask(mask: NDArray[np.bool_], mesh: TriangleMesh | Points, coarse: int) -> FloatArray:
    """Distance of each vertex from the nearest painted pixel [px], to about a pixel; infinite without any: [v]."""
    import cv2

    if not mask.any():
        return np.full(len(mesh.vertices), np.inf)
    checkpoint()
    size = np.array([mask.shape[1], mask.shape[0]])
    scaled = mesh.vertices * (size / [mesh.width, mesh.height])
    column, row = np.clip(np.floor(scaled), 0, size - 1).astype(np.int64).T
    empty = (_coarser(mask, coarse) == 0).view(np.uint8)
    distances = cv2.distanceTransform(empty, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    found = distances[row // coarse, column // coarse].astype(np.float64) * coarse
    return found * (mesh.longest_side / float(size.max()))


def _coarser(mask: NDArray[np.bool_], coarse: int) -> NDArray[np.uint8]:
    """Whether anything is painted in each square of so many pixels each way, above 0 there."""
    painted = mask.view(np.uint8)
    if coarse == 1:
        return painted
    rows, columns = (-(-length // coarse) for length in mask.shape)
    result = np.zeros((rows, columns), np.uint8)
    bands = np.zeros((min(rows, _ROWS_AT_ONCE), columns * coarse), np.uint8)
    for top in range(0, rows, len(bands)):
        filled = result[top : top + len(bands)]
        for number, band in enumerate(bands[: len(filled)], start=top):
            np.bitwise_or.reduce(painted[number * coarse : (number + 1) * coarse], axis=0, out=band[: mask.shape[1]])
        for first in range(coarse):
            filled |= bands[: len(filled), first::coarse]
    return result
