"""Strands: a mesh of hair slit along the lines that are drawn between its locks, so that they swing apart and overlap.

Only the mesh is slit: at rest nothing changes, and each side carries the picture up to the line.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..physics.mesh import PixelBox, TriangleMesh, bounding_box, cut_along, interpolate, ways_along, ways_from
from ..physics.rig import vertices_of
from ..physics.scene import Body, Held, pins
from .peaks import prominent_peaks
from .pictures import as_float, is_transparent
from .strand_lines import Field, darkness, lines_from

__all__ = ["split_into_strands"]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]

_ACROSS = 640  # cells along the longer side of a part
_TIP = 0.05  # how far a tip sticks out beyond the notches beside it, as a share of the longest way from the root
# Share of the way from the root to the tips beside a slit that stays whole: slits in front hair open onto the face or
# more hair, those in hair behind a head onto the backdrop, which shows through hair that should be full.
_ROOT, _ROOT_BEHIND = 1 / 3, 0.6
# A slit is at most so many times as long as the shorter of the tips beside it sticks out: a tip of which little more
# than its point is seen would else come loose on all its length, and flap between the locks that it lies among.
_LONGEST = 2.0
_SHORTEST = 3  # edges of a slit at least
_KEPT = 0.35  # of the least height of the triangles around a vertex that is moved onto a line
_ASTRAY = 4.0  # how dear it is for a slit to leave its line by an edge's length


def split_into_strands(image: NDArray[Any], body: Body, *, attach: Held = "auto", alone: bool = False) -> TriangleMesh:
    """The mesh of a body slit between its strands; as it is where nothing is drawn between them.

    Args:
        image: what the body shows, RGB or straight RGBA, uint8 or float32 in 0 to 1, shape [h, w, 3] or [h, w, 4].
        body: hair, or a ribbon.
        attach: where it is held.
        alone: whether the picture shows the body alone, with what is hidden of it; otherwise nothing is looked for
            where something covers it.
    """
    mesh = body.mesh
    held = np.logical_or.reduce([vertices_of(pin, mesh) for pin in pins(body, 0, attach=attach)])
    ways = ways_from(mesh, held)
    notches, until, tips = _notches(mesh, ways, whole=_ROOT_BEHIND if attach == "covered" else _ROOT)
    if not len(notches):
        return mesh
    whole = mesh
    field, corner, scale = _field(image, mesh, ways, cover=None if alone else body.cover)
    lines = lines_from(field, (mesh.vertices[notches] - corner) * scale - 0.5, until=until * scale)
    for notch, line in sorted(zip(notches, lines, strict=True), key=lambda each: -len(each[1])):
        if len(line):
            mesh = _slit(mesh, int(notch), (line + 0.5) / scale + corner)
    return mesh if mesh is whole else _strand_by_strand(mesh, tips)


def _strand_by_strand(mesh: TriangleMesh, tips: IndexArray) -> TriangleMesh:
    """The mesh with the triangles of each strand together, since later ones are drawn over earlier ones."""
    from scipy.sparse.csgraph import dijkstra

    graph = ways_along(mesh.vertices, mesh.triangles)
    _, _, nearest = dijkstra(graph, directed=False, indices=tips, min_only=True, return_predecessors=True)
    rank = np.full(len(mesh.vertices), -1)
    rank[tips] = np.arange(len(tips))
    strand = np.where(nearest >= 0, rank[np.maximum(nearest, 0)], -1)
    order = np.argsort(strand[mesh.triangles].max(axis=1), kind="stable")
    return TriangleMesh(mesh.vertices, mesh.triangles[order], mesh.width, mesh.height)


def _notches(mesh: TriangleMesh, ways: FloatArray, *, whole: float) -> tuple[IndexArray, FloatArray, IndexArray]:
    """Vertices at which two tips part, how near the root a slit from each may come [px], and the tips, in order."""
    found, until = [], []
    ends: list[int] = []
    for loop in _loops(mesh):
        along = ways[loop]
        if not np.isfinite(along).all() or len(loop) < 8:
            continue
        start = int(np.argmin(along))
        loop, along = np.roll(loop, -start), np.roll(along, -start)
        tips = prominent_peaks(np.append(along, along[0]), _TIP * float(ways[np.isfinite(ways)].max()))
        ends.extend(loop[tips % len(loop)])
        for one, other in pairwise(tips):
            notch = one + int(np.argmin(along[one:other]))
            shorter = min(along[one], along[other])
            limit = max(whole * shorter, along[notch] - _LONGEST * (shorter - along[notch]))
            if along[notch] > limit:
                found.append(loop[notch])
                until.append(limit)
    return np.array(found, dtype=np.int64), np.array(until), np.array(ends, dtype=np.int64)


def _loops(mesh: TriangleMesh) -> list[IndexArray]:
    """Vertices along each closed line of the boundary."""
    following = dict(mesh.boundary_edges.tolist())
    loops = []
    while following:
        first, vertex = next(iter(following.items()))
        loop = [first]
        del following[first]
        while vertex in following:
            loop.append(vertex)
            vertex = following.pop(vertex)
        loops.append(np.array(loop))
    return loops


def _field(
    image: NDArray[Any], mesh: TriangleMesh, ways: FloatArray, *, cover: NDArray[np.bool_] | None
) -> tuple[Field, FloatArray, float]:
    """The part in cells, and where they begin [px], and how many there are to a pixel."""
    box = bounding_box(mesh.vertices).clipped(mesh.width, mesh.height)
    scale = min(1.0, _ACROSS / max(box.width, box.height))
    size = max(1, round(box.width * scale)), max(1, round(box.height * scale))
    corner = np.array([box.left, box.top], dtype=np.float64)
    points = (mesh.vertices - corner) * scale
    cells = PixelBox(0, 0, *size)
    known = np.where(np.isfinite(ways), ways * scale, 0)
    (spread,) = interpolate(points, mesh.triangles, known[:, None], cells, fill=-1)
    inside = spread >= 0
    grey = cv2.resize(_grey(image[box.slices]), size, interpolation=cv2.INTER_AREA)
    lines = darkness(grey, inside)
    if cover is not None:  # what is seen there is drawn on something else
        hidden = cv2.resize(cover[box.slices].astype(np.uint8), size, interpolation=cv2.INTER_NEAREST)
        lines[hidden > 0] = 0
    return Field(inside, spread, lines), corner, scale


def _grey(image: NDArray[Any]) -> NDArray[np.float32]:
    """Lightness, 0 to 1; of what is transparent that of white, shape [h, w]."""
    picture = as_float(image)
    colours = picture[..., :3]
    if is_transparent(picture):
        colours = colours * picture[..., 3:] + (1 - picture[..., 3:])
    return np.asarray(cv2.cvtColor(np.ascontiguousarray(colours, dtype=np.float32), cv2.COLOR_RGB2GRAY))


def _slit(mesh: TriangleMesh, notch: int, line: FloatArray) -> TriangleMesh:
    """The mesh cut from a vertex of its boundary along a line [px]; as it is where there is no room."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import dijkstra
    from scipy.spatial import cKDTree

    edges = mesh.edges.astype(np.int64)
    border = np.zeros(len(mesh.vertices), dtype=bool)
    border[mesh.boundary_edges] = True
    border[notch] = False
    free = edges[~border[edges].any(axis=1)]
    ends = mesh.vertices[free]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    away, _ = cKDTree(line).query(ends.mean(axis=1))
    usual = float(np.median(lengths)) if len(lengths) else 1.0
    cost = lengths * (1 + _ASTRAY * (away / usual) ** 2)
    size = len(mesh.vertices)
    graph = coo_array((cost, tuple(free.T)), shape=(size, size)).tocsr()
    costs, before = dijkstra(graph, directed=False, indices=notch, return_predecessors=True)
    near = np.where(np.isfinite(costs), np.linalg.norm(mesh.vertices - line[-1], axis=1), np.inf)
    path = [int(np.argmin(near))]
    while path[-1] != notch:
        path.append(int(before[path[-1]]))
    path = path[::-1]
    if len(path) <= _SHORTEST:
        return mesh
    vertices = _on_line(mesh, path[1:], line)
    moved = TriangleMesh(vertices, mesh.triangles, mesh.width, mesh.height)
    return cut_along(moved, np.stack([path[:-1], path[1:]], axis=1))


def _on_line(mesh: TriangleMesh, path: list[int], line: FloatArray) -> FloatArray:
    """Vertices with those of a path moved onto a line as far as no triangle gets much flatter: flat ones cost steps."""
    from scipy.spatial import cKDTree

    vertices, tree = mesh.vertices.copy(), cKDTree(line)
    for vertex in path:
        around = mesh.triangles[(mesh.triangles == vertex).any(axis=1)]
        least, place = _KEPT * _heights(vertices[around]).min(), vertices[vertex].copy()
        target = line[tree.query(place)[1]]
        for share in (1.0, 0.75, 0.5, 0.25, 0.0):
            vertices[vertex] = place + share * (target - place)
            if _heights(vertices[around]).min() >= least:
                break
    return vertices


def _heights(corners: FloatArray) -> FloatArray:
    """Height of triangles above their longest side [px]; negative where a triangle is turned over."""
    sides = np.roll(corners, -1, axis=1) - corners
    doubled = sides[:, 1, 0] * sides[:, 0, 1] - sides[:, 1, 1] * sides[:, 0, 0]
    return np.asarray(doubled / np.linalg.norm(sides, axis=2).max(axis=1))
