"""Outlines around the vertices that are held, as polygons that an editor shows and people can change."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..mesh import TriangleMesh

__all__ = ["hull_around", "outlines_around"]

Outline = tuple[tuple[float, float], ...]

_MARGIN = 0.01  # around what is held, as a share of the part, and at most 1 px
_FINEST = 2048  # cells across the box of what is held, at most
_CELLS = 4  # that the reach around a vertex has
_AROUND = 0.45  # around a vertex that is held, in lengths of the shortest edge there
_SLACK = 0.4  # that an outline may be off, as a share of that reach
_STRAY = 0.02  # vertices that a hull may hold beyond those meant, as a share of these


def outlines_around(mesh: TriangleMesh, held: NDArray[np.bool_]) -> list[Outline]:
    """Polygons [px] that hold these vertices of a mesh and hardly any other, one for each patch of them.

    Args:
        mesh: the mesh.
        held: which vertices are held, shape [v].
    """
    hull = hull_around(mesh.vertices[held], extent=float(np.ptp(mesh.vertices[held], axis=0).max()))
    corners = np.array(hull, dtype=np.float32)
    others = mesh.vertices[~held].astype(np.float32)
    near = others[((others >= corners.min(axis=0)) & (others <= corners.max(axis=0))).all(axis=1)]
    stray = sum(cv2.pointPolygonTest(corners, (float(x), float(y)), False) >= 0 for x, y in near)
    return [hull] if stray <= _STRAY * held.sum() else _patches(mesh, held)


def _patches(mesh: TriangleMesh, held: NDArray[np.bool_]) -> list[Outline]:
    """Outlines of the triangles, edges and surroundings of the vertices that are held."""
    ends = mesh.vertices[mesh.edges]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    room = np.full(len(held), np.inf)
    for column in (0, 1):
        np.minimum.at(room, mesh.edges[:, column], lengths)
    radius = _AROUND * float(room[held].min())
    corner = mesh.vertices[held].min(axis=0) - 2 * radius
    span = np.ptp(mesh.vertices[held], axis=0) + 4 * radius
    scale = min(_FINEST / float(span.max()), _CELLS / radius)
    canvas = np.zeros(np.ceil(span[::-1] * scale).astype(int) + 1, dtype=np.uint8)
    fixed = np.rint((mesh.vertices - corner) * scale * 16).astype(np.int32)
    for triangle in fixed[mesh.triangles[held[mesh.triangles].all(axis=1)]]:
        cv2.fillConvexPoly(canvas, triangle, 1, shift=4)
    for place in fixed[held]:
        cv2.circle(canvas, place.tolist(), 0, 1, -1, shift=4)
    for start, end in fixed[mesh.edges[held[mesh.edges].all(axis=1)]]:
        cv2.line(canvas, start.tolist(), end.tolist(), 1, shift=4)
    reach = max(1, round(radius * scale))
    canvas = cv2.dilate(canvas, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1,) * 2))
    found, _ = cv2.findContours(canvas, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    outlines = [cv2.approxPolyDP(each, _SLACK * radius * scale, True)[:, 0] for each in found]
    return [_points(each / scale + corner) for each in outlines if len(each) > 2]


def hull_around(held: NDArray[np.float64], *, extent: float) -> Outline:
    """Convex outline [px] around points.

    Args:
        held: the points [px], at least one, shape [n, 2].
        extent: of the part that they belong to [px].
    """
    from scipy.spatial import ConvexHull

    # A margin keeps the vertices inside the polygon in spite of rounding, and gives collinear ones an area.
    margin = min(1.0, _MARGIN * extent)
    corners = np.concatenate([held + margin * np.array(offset) for offset in ((-1, -1), (-1, 1), (1, -1), (1, 1))])
    return _points(corners[ConvexHull(corners).vertices])


def _points(corners: NDArray[np.floating]) -> Outline:
    return tuple((float(x), float(y)) for x, y in corners)
