"""Conforming Delaunay triangulation of polygons, with interior points spread for well-shaped triangles."""

from __future__ import annotations

import atexit
import threading
from collections.abc import Sequence
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..process_end import wait_to_the_end
from .spacing import SpacingField

__all__ = ["CrossingEdgesError", "interior_seeds", "morton_order", "triangulate"]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]

_CLEARANCE = 0.65
_SEPARATION = 0.75
_LATTICE_RATIO = 2**0.5
_SMOOTHING_ROUNDS = 3
# Weight of a triangle in smoothing: its area times spacing to the minus this power.
_CROWDING = 2.5
# Shortest edges that refinement makes, in shortest edges of the polygons. In a tip that is little wider than the wanted
# angle the first makes very low triangles, for which the whole body would take smaller steps; then the next is tried.
_SHORTEST_EDGES = (0.25, 0.35, 0.5, 0.7, 1.0)
_LOWEST_TRIANGLE = 0.15  # smallest spacings; an equilateral one is 0.87 high
_MOST_NEW_POINTS = 4
_LAST_SECONDS = 30.0

# Held while the library triangulates. The end of the process takes it for good: a thread that came back from the
# library after that would find no interpreter, and abort.
_at_work = threading.Lock()
atexit.register(wait_to_the_end, partial(_at_work.acquire, True), _LAST_SECONDS)


class CrossingEdgesError(Exception):
    """Two boundary edges cross."""


def interior_seeds(loops: Sequence[FloatArray], field: SpacingField, inside: NDArray[np.bool_]) -> FloatArray:
    """Points of hexagonal lattices, one for each class of spacing, clear of the boundary and of each other.

    Args:
        loops: boundary polygons [px], each of shape [n, 2].
        field: wanted spacing.
        inside: the shape by pixels, shape [h, w].

    Returns:
        Points [px], shape [m, 2].
    """
    from scipy.spatial import cKDTree

    vertices = np.concatenate(loops)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    boundary = cKDTree(np.concatenate([_with_points_between(loop, 4) for loop in loops]))
    spacings = _lattice_spacings(field)
    chosen = np.empty((0, 2))
    for number, spacing in enumerate(spacings):
        points = _lattice(low, high, spacing)
        column, row = np.clip(points.astype(np.int64), 0, np.array(inside.shape)[::-1] - 1).T
        points = points[inside[row, column]]
        points = points[np.abs(np.log(field.at(points)[:, None] / spacings)).argmin(axis=1) == number]
        points = points[boundary.query(points)[0] >= _CLEARANCE * spacing]
        points = points[cKDTree(chosen).query(points)[0] >= _SEPARATION * spacing] if len(chosen) else points
        chosen = np.concatenate([chosen, points])
    return chosen


def triangulate(
    loops: Sequence[FloatArray], seeds: FloatArray, field: SpacingField, *, min_angle: float, refine: bool = True
) -> tuple[FloatArray, IndexArray]:
    """Triangulate the area that polygons bound.

    The seeds are first moved towards the middle of their surroundings (centroidal patch triangulation).

    Args:
        loops: boundary polygons [px], each of shape [n, 2]; one within another is a hole.
        seeds: interior points [px], shape [m, 2].
        field: wanted spacing.
        min_angle: refine until no angle [degrees] is smaller, except at sharp corners of the polygons.
        refine: otherwise add no points, unless triangles are very low without.

    Returns:
        Vertices [px], shape [v, 2], and triangles, shape [t, 3]. The polygons' points come first.

    Raises:
        CrossingEdgesError: polygons cross themselves or each other.
    """
    boundary, edges = np.concatenate(loops), _closing_edges(loops)
    for _ in range(_SMOOTHING_ROUNDS):
        points, triangles = _delaunay(boundary, seeds, edges)
        seeds = _centred(points, triangles, field)[len(boundary) :]
    lowest = _LOWEST_TRIANGLE * float(field.values.min())
    if not refine:
        plain = _delaunay(boundary, seeds, edges)
        if _lowest_altitude(*plain) >= lowest:
            return plain
    return _refined(boundary, seeds, edges, min_angle=min_angle, lowest=lowest)


def morton_order(points: FloatArray) -> IndexArray:
    """Indices that sort points along a Z-curve, so that neighbours in the plane are neighbours in memory."""
    extent = float(np.ptp(points, axis=0).max()) or 1.0
    cells = ((points - points.min(axis=0)) / extent * 65535).astype(np.uint64)
    key = _spread_bits(cells[:, 0]) | (_spread_bits(cells[:, 1]) << np.uint64(1))
    return np.argsort(key, kind="stable")


def _refined(
    boundary: FloatArray, seeds: FloatArray, edges: NDArray[np.uint32], *, min_angle: float, lowest: float
) -> tuple[FloatArray, IndexArray]:
    """The triangulation refined as far as no triangle gets lower than ``lowest`` [px], or else the highest found."""
    sides = float(np.hypot(*(boundary[edges[:, 1]] - boundary[edges[:, 0]]).T).min())
    found = []
    for factor in _SHORTEST_EDGES:
        mesh = _delaunay(boundary, seeds, edges, min_angle=min_angle, shortest=factor * sides)
        found.append((_lowest_altitude(*mesh), mesh))
        if found[-1][0] >= lowest:
            break
    return max(found, key=lambda each: each[0])[1]


def _lowest_altitude(points: FloatArray, triangles: IndexArray) -> float:
    """Altitude of the lowest triangle [px]."""
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    u, v = b - a, c - a
    longest = np.max([np.hypot(*side.T) for side in (u, v, v - u)], axis=0)
    return float((np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / longest).min(initial=np.inf))


def _delaunay(
    boundary: FloatArray,
    seeds: FloatArray,
    edges: NDArray[np.uint32],
    *,
    min_angle: float | None = None,
    shortest: float = 0.0,
) -> tuple[FloatArray, IndexArray]:
    import pythoncdt as cdt

    points = np.concatenate([boundary, seeds])
    with _at_work:
        work = cdt.Triangulation(cdt.VertexInsertionOrder.AUTO, cdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0)
        work.insert_vertices(points)
        try:
            work.insert_edges(edges)
        except RuntimeError as error:
            raise CrossingEdgesError(str(error)) from error
        outer = work.collect_outer_triangles_and_holes()
        if min_angle is not None:
            angle = cdt.deg_to_rad(min_angle)
            most = _MOST_NEW_POINTS * len(points)
            work.refine_triangles(most, cdt.RefinementCriterion.SMALLEST_ANGLE, angle, outer, shortest)
        work.finalize_triangulation(outer)
        found = work.vertices_array()
        return np.stack([found["x"], found["y"]], axis=1), work.triangles_array()["vertices"].astype(np.int64)


def _centred(points: FloatArray, triangles: IndexArray, field: SpacingField) -> FloatArray:
    """Every point moved to the weighted mean of the centroids of its triangles."""
    corners = points[triangles]
    centroids = corners.mean(axis=1)
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    weights = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / field.at(centroids) ** _CROWDING
    corner, weights = triangles.reshape(-1), np.repeat(weights, 3)
    total = np.bincount(corner, weights, minlength=len(points))
    sums = [np.bincount(corner, weights * np.repeat(axis, 3), minlength=len(points)) for axis in centroids.T]
    used = total > 0
    moved = points.copy()
    moved[used] = np.stack(sums, axis=1)[used] / total[used, None]
    return moved


def _lattice_spacings(field: SpacingField) -> FloatArray:
    finest, coarsest = float(field.values.min()), float(field.values.max())
    return np.geomspace(finest, coarsest, 1 + round(np.log(coarsest / finest) / np.log(_LATTICE_RATIO)))


def _lattice(low: FloatArray, high: FloatArray, spacing: float) -> FloatArray:
    """Points of a hexagonal lattice over a rectangle [px], shape [n, 2]."""
    rise = spacing * np.sqrt(3) / 2
    columns, rows = ((high - low) / (spacing, rise)).astype(np.int64) + 2
    x = low[0] + spacing * (np.arange(columns)[None, :] + 0.5 * (np.arange(rows)[:, None] % 2))
    y = np.broadcast_to(low[1] + rise * np.arange(rows)[:, None], x.shape)
    return np.stack([x.reshape(-1), y.reshape(-1)], axis=1)


def _with_points_between(loop: FloatArray, pieces: int) -> FloatArray:
    """The points of a closed polygon and further ones that cut each side into pieces [px], shape [n pieces, 2]."""
    side = np.roll(loop, -1, axis=0) - loop
    return (loop[:, None] + side[:, None] * (np.arange(pieces) / pieces)[None, :, None]).reshape(-1, 2)


def _closing_edges(loops: Sequence[FloatArray]) -> NDArray[np.uint32]:
    """Index pairs that close each of several polygons whose points are concatenated, shape [e, 2]."""
    starts = np.cumsum([0, *map(len, loops)])
    following = [np.roll(np.arange(a, b), -1) for a, b in pairwise(starts)]
    return np.stack([np.arange(starts[-1]), np.concatenate(following)], axis=1).astype(np.uint32)


def _spread_bits(value: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """The low 16 bits of each number, with a zero between any two."""
    for shift, kept in ((8, 0x00FF00FF), (4, 0x0F0F0F0F), (2, 0x33333333), (1, 0x55555555)):
        value = (value | (value << np.uint64(shift))) & np.uint64(kept)
    return value
