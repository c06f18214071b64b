"""Where tracks begin: points on the bodies, and points of the background that no body ever covers."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidInputError
from ..mesh import PixelBox, barycentric, triangle_ids
from .farthest_points import farthest_points
from .flow import layer_order, without_covered
from .motion import Motion

__all__ = ["BodyPoints", "Frame", "background_points", "body_points", "stacked_triangles"]

FloatArray = NDArray[np.float64]

_MOST_CANDIDATES = 20_000
_INSET = 0.004  # [side]: tracks keep off outlines, where a model would take the background along
_LEAST_WEIGHT = 0.02  # of a point that does not move, relative to the one that moves farthest
_MARGIN = 0.025  # [side]: wanted between a point of the background and the bodies
_GRID = 320  # [cells] on the longest side, for finding the background: quick, and fine enough for a few points


@dataclass(frozen=True)
class Frame:
    """The part of the illustration that tracks are wanted for [px].

    Attributes:
        left: of its left edge.
        top: of its top edge.
        right: of its right edge.
        bottom: of its bottom edge.
    """

    left: float
    top: float
    right: float
    bottom: float

    def holds(self, points: NDArray[np.floating]) -> NDArray[np.bool_]:
        """Whether points lie in it, shape [...] for points of shape [..., 2]."""
        x, y = points[..., 0], points[..., 1]
        return (x >= self.left) & (x < self.right) & (y >= self.top) & (y < self.bottom)


@dataclass(frozen=True, eq=False)
class BodyPoints:
    """Points that are fixed to bodies.

    Attributes:
        corners: vertices of the motion about each point, shape [n, 3].
        weights: barycentric coordinates in them, shape [n, 3].
        body: number of the body of each point, shape [n].
    """

    corners: NDArray[np.int64]
    weights: FloatArray
    body: NDArray[np.int64]

    def __getitem__(self, chosen: NDArray[np.int64]) -> BodyPoints:
        return BodyPoints(self.corners[chosen], self.weights[chosen], self.body[chosen])

    def at(self, positions: NDArray[np.floating]) -> FloatArray:
        """Where the points are when the motion's vertices are at ``positions`` [px], shape [..., n, 2]."""
        return np.einsum("nk,...nkd->...nd", self.weights, positions[..., self.corners, :])


def stacked_triangles(motion: Motion) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Triangles of all bodies from back to front, indexing the motion's vertices, [t, 3]; and their bodies, [t]."""
    starts = np.cumsum([0] + [len(body.mesh.vertices) for body in motion.bodies])
    order = layer_order(motion.bodies)
    triangles = [motion.bodies[k].mesh.triangles.astype(np.int64) + starts[k] for k in order]
    return np.concatenate(triangles), np.repeat(order, [len(each) for each in triangles])


def body_points(motion: Motion, count: int, *, frame: Frame, weighting: float) -> BodyPoints:
    """Points on what can be seen of the bodies in the first frame, farthest-point sampled.

    Args:
        motion: how the bodies move.
        count: how many points; fewer where the bodies have fewer pixels.
        frame: where in the illustration they may begin.
        weighting: exponent on how far a point moves; 0 covers the bodies evenly.

    Raises:
        InvalidInputError: no body can be seen there.
    """
    candidates = _candidates(motion, frame)
    start = candidates.at(motion.positions[0])
    reach = np.zeros(len(start))
    for positions in motion.positions[1:]:
        reach = np.maximum(reach, np.hypot(*(candidates.at(positions) - start).T))
    weights = np.maximum(reach / max(reach.max(), 1e-9), _LEAST_WEIGHT) ** weighting
    return candidates[farthest_points(start, count, weights=weights)]


def _candidates(motion: Motion, frame: Frame) -> BodyPoints:
    """A grid of points on what can be seen of the bodies in the first frame."""
    triangles, bodies = stacked_triangles(motion)
    first = motion.positions[0].astype(np.float64)
    ids = triangle_ids(first, triangles, PixelBox(0, 0, motion.width, motion.height))
    ids = without_covered(ids, motion.bodies)
    owner = np.where(ids >= 0, bodies[ids], -1)
    inside = np.zeros(ids.shape, dtype=bool)
    for number in range(len(motion.bodies)):
        inside |= _inset(owner == number, _INSET * max(motion.width, motion.height))
    rows, columns = np.nonzero(inside)
    kept = frame.holds(np.stack([columns + 0.5, rows + 0.5], axis=1))
    rows, columns = rows[kept], columns[kept]
    if not len(rows):
        raise InvalidInputError("tracks need a body in the first frame of the picture. Got: none can be seen there")
    step = int(np.ceil(np.sqrt(len(rows) / _MOST_CANDIDATES)))
    on_grid = (rows % step == 0) & (columns % step == 0)
    if step > 1 and on_grid.any():
        rows, columns = rows[on_grid], columns[on_grid]
    found = ids[rows, columns]
    points = np.stack([columns + 0.5, rows + 0.5], axis=1)
    corners = triangles[found]
    return BodyPoints(corners, barycentric(points, first[corners]), bodies[found])


def _inset(visible: NDArray[np.bool_], distance: float) -> NDArray[np.bool_]:
    """The pixels that lie at least so far inside; where all is thin, the inner half."""
    depth = cv2.distanceTransform(visible.astype(np.uint8), cv2.DIST_L2, 3)
    return visible & (depth >= min(distance, 0.5 * float(depth.max())))


def background_points(motion: Motion, count: int, *, frame: Frame) -> FloatArray:
    """Points of the background that no body covers in any frame, spread out evenly [px], shape [k, 2].

    Args:
        motion: how the bodies move.
        count: how many points; fewer where the bodies leave less room.
        frame: where in the illustration they may be.
    """
    scale = _GRID / max(motion.width, motion.height)
    shape = max(1, round(motion.height * scale)), max(1, round(motion.width * scale))
    scale_to_grid = np.array([shape[1] / motion.width, shape[0] / motion.height])
    box = PixelBox(0, 0, shape[1], shape[0])
    triangles, _ = stacked_triangles(motion)
    reached = np.zeros(shape, dtype=np.uint8)
    for positions in motion.positions:
        on_grid = positions.astype(np.float64) * scale_to_grid
        reached[triangle_ids(on_grid, triangles, box) >= 0] = 1
        # What is thinner than a cell may miss all its centres.
        x, y = np.floor(on_grid).astype(np.int64).T
        seen = (x >= 0) & (y >= 0) & (x < shape[1]) & (y < shape[0])
        reached[y[seen], x[seen]] = 1
    free = cv2.dilate(reached, np.ones((5, 5), np.uint8)) == 0
    rows, columns = np.indices(shape)
    cells = np.stack([columns + 0.5, rows + 0.5], axis=-1) / scale_to_grid
    free &= frame.holds(cells)
    # Points keep off the bodies' reach and the picture's edge where there is room to.
    depth = cv2.distanceTransform(np.pad(free, 1).astype(np.uint8), cv2.DIST_L2, 3)[1:-1, 1:-1]
    weights = np.minimum(depth[free] / (_MARGIN * _GRID), 1.0).astype(np.float64)
    return cells[free][farthest_points(cells[free], count, weights=weights)]
