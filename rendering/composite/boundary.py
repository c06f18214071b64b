"""The boundary of a mesh: what lies ahead of each of its edges, and how wide an apron has room there.

The two sides of a slit have the same places at rest: nothing lies between them, and they are no boundary here.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, TriangleMesh, barycentric, half_edges, on_boundary, rasterise, triangle_ids
from ..pictures import nearest_pixels

__all__ = ["SHARPEST_MITRE", "Boundary", "same_places"]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]

# Beyond the last pixel of the rim, so that resampling reads the transparent pixels next to it.
_MARGIN = 2.0
# No apron is narrower than a pixel, so that none of its triangles is empty [px].
_NARROWEST = 1.0
SHARPEST_MITRE = 2.0
"""A mitred corner lies at most this many apron widths from the boundary, however sharp the boundary turns."""

# Triangles that are at most so many steps from an edge are nearby.
_NEARBY = 2

# Along the boundary, pixels of edges closer than this many apron widths count as the same strand's.
_NEAR = 3.0


class Boundary:
    """The boundary edges of a mesh, each with the next one around the same loop."""

    def __init__(self, mesh: TriangleMesh) -> None:
        self.mesh = mesh
        whole = same_places(mesh.vertices)[mesh.triangles]
        outer = on_boundary(half_edges(whole))
        self.edges = half_edges(mesh.triangles)[outer].astype(np.int64)
        self.next = _successors(half_edges(whole)[outer])
        self.owner = np.tile(np.arange(len(whole)), 3)[outer]
        # A slit begins where an edge ends in one vertex and the next one starts in another.
        self.parted = np.flatnonzero(self.edges[:, 1] != self.edges[self.next, 0])
        self.start, self.end = (mesh.vertices[self.edges[:, k]] for k in (0, 1))
        along = self.end - self.start
        self.length = np.linalg.norm(along, axis=1)
        self.normal = np.stack([along[:, 1], -along[:, 0]], axis=1) / self.length[:, None]
        inward = mesh.vertices[mesh.triangles[self.owner]].mean(axis=1) - self.start
        self.normal *= -np.sign(np.einsum("ij,ij->i", inward, self.normal))[:, None]
        self.loop, self.place, self.circumference = self._walked()

    def widths(self, alpha: NDArray[np.float32], canvas: PixelBox, reach: float) -> FloatArray:
        """Apron width at the end of each edge [px]: wide enough for the rim, too narrow for the next strand's."""
        distance, nearest = self._nearest_edge(canvas)
        outside = triangle_ids(self.mesh.vertices, self.mesh.triangles, canvas) < 0
        rim = outside & (alpha > 0) & (distance <= reach)
        needed = np.full(len(self.edges), _NARROWEST)
        np.maximum.at(needed, nearest[rim], distance[rim] + _MARGIN)
        needed = np.maximum(needed, needed[self.next])
        free = self._free_width(needed, canvas, distance, nearest)
        return np.maximum(np.minimum(needed, np.minimum(free, free[self.next])), _NARROWEST)

    def corners(self, widths: FloatArray) -> FloatArray:
        """Outer corner at the end of each edge [px], mitred, then those where slits begin once more, shape [c, 2]."""
        both = self.normal + self.normal[self.next]
        length = np.linalg.norm(both, axis=1)
        along = (self.end - self.start) / self.length[:, None]
        # At a spike's tip both normals cancel: the corner lies straight ahead.
        direction = np.where(length[:, None] > 1e-6, both / np.maximum(length, 1e-6)[:, None], along)
        mitre = np.minimum(2 / np.maximum(length, 1e-6), SHARPEST_MITRE)
        corners = self.end + direction * (widths * mitre)[:, None]
        return np.concatenate([corners, corners[self.parted]])

    def quads(self, first: int) -> IndexArray:
        """Two triangles for each edge; corner c has the number ``first`` + c."""
        previous = np.empty(len(self.edges), dtype=np.int64)
        previous[self.next] = np.arange(len(self.edges))
        previous[self.next[self.parted]] = len(self.edges) + np.arange(len(self.parted))
        a, b = self.edges.T
        outer_a, outer_b = first + previous, first + np.arange(len(self.edges))
        return np.concatenate([np.stack([a, b, outer_b], axis=1), np.stack([a, outer_b, outer_a], axis=1)])

    def over(self) -> IndexArray:
        """For each edge the triangle before which its quads are drawn, 0 where the boundary has no slits, shape [e].

        A strand's triangles follow one another. Its quads lie over the strands before, and under its own triangles
        nearby, which they overlap where it is bent.
        """
        triangles = self.mesh.triangles
        lowest = np.full(len(self.mesh.vertices), len(triangles))
        for _ in range(_NEARBY):
            np.minimum.at(
                lowest, triangles, np.minimum(lowest[triangles].min(axis=1), np.arange(len(triangles)))[:, None]
            )
        return np.where(np.isin(self.loop, self.loop[self.parted]), lowest[self.edges].min(axis=1), 0)

    def leading(self, outer: FloatArray) -> tuple[IndexArray, FloatArray]:
        """The vertices that each outer corner follows, shape [c, 6], and their weights, of sum 1.

        They are those of the triangles on both sides of the corner, by the mean of whose affine maps it moves; where a
        slit begins, those of the one side or of the other.
        """
        before, after = self.owner, self.owner[self.next]
        beyond = after[self.parted]
        after[self.parted] = before[self.parted]
        corners = self.mesh.triangles[[np.concatenate([before, beyond]), np.concatenate([after, beyond])]].astype(int)
        weights = np.stack([barycentric(outer, self.mesh.vertices[triangle]) for triangle in corners])
        return np.concatenate(list(corners), axis=1), np.concatenate(list(weights), axis=1) / 2

    def _free_width(
        self, needed: FloatArray, canvas: PixelBox, distance: NDArray[np.float32], nearest: IndexArray
    ) -> FloatArray:
        """How far from each edge the first pixel of another strand lies [px], infinite where there is none.

        Another strand is another loop of the boundary, or a place far along the same one.
        """
        trial = self.corners(needed)
        points = np.concatenate([self.mesh.vertices, trial])
        fragments = rasterise(points, self.quads(len(self.mesh.vertices)), canvas)
        edge, pixel = fragments.triangles() % len(self.edges), fragments.pixels()
        other = nearest.reshape(-1)[pixel]
        apart = np.abs(self.place[edge] - self.place[other])
        apart = np.minimum(apart, self.circumference[edge] - apart)
        foreign = (self.loop[edge] != self.loop[other]) | (apart > _NEAR * (needed[edge] + self.length[edge]))
        edge, pixel = edge[foreign], pixel[foreign]
        row, column = np.divmod(pixel, canvas.width)
        centre = np.stack([column + canvas.left + 0.5, row + canvas.top + 0.5], axis=1)
        height = np.einsum("ij,ij->i", centre - self.start[edge], self.normal[edge])
        free = np.full(len(self.edges), np.inf)
        np.minimum.at(free, edge, height)
        return free

    def _nearest_edge(self, canvas: PixelBox) -> tuple[NDArray[np.float32], IndexArray]:
        """Distance to the boundary [px] and the number of the nearest edge, at each pixel of the canvas."""
        steps = np.maximum(np.ceil(self.length * 2), 1).astype(np.int64)
        edge = np.repeat(np.arange(len(self.edges)), steps)
        part = (np.arange(len(edge)) - np.repeat(np.cumsum(steps) - steps, steps) + 0.5) / steps[edge]
        points = self.start[edge] + (self.end - self.start)[edge] * part[:, None]
        column, row = (np.floor(points) - (canvas.left, canvas.top)).astype(np.int64).T
        seeds = np.full((canvas.height, canvas.width), -1, dtype=np.int64)
        seeds[row, column] = edge
        distance, nearest = nearest_pixels(seeds >= 0)
        return distance, seeds.ravel()[nearest]

    def _walked(self) -> tuple[IndexArray, FloatArray, FloatArray]:
        """Loop of each edge, its place along it [px], and the loop's circumference [px]."""
        loop = np.full(len(self.edges), -1, dtype=np.int64)
        place, circumference = np.zeros(len(self.edges)), np.zeros(len(self.edges))
        for first in range(len(self.edges)):
            if loop[first] >= 0:
                continue
            chain, edge = [], first
            while loop[edge] < 0:
                loop[edge] = first
                chain.append(edge)
                edge = int(self.next[edge])
            ends = np.cumsum(self.length[chain])
            place[chain], circumference[chain] = ends, ends[-1]
        return loop, place, circumference


def same_places(points: FloatArray) -> IndexArray:
    """For each point the first one at the very same place, shape [n], of points of shape [n, 2]."""
    _, first, same = np.unique(points, axis=0, return_index=True, return_inverse=True)
    return np.asarray(first[same.ravel()])


def _successors(edges: NDArray[np.integer]) -> IndexArray:
    """Number of an edge that starts where each edge ends; every edge follows exactly one."""
    followers = np.empty(len(edges), dtype=np.int64)
    followers[np.argsort(edges[:, 1], kind="stable")] = np.argsort(edges[:, 0], kind="stable")
    return followers
