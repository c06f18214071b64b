"""The apron: quads around a mesh that carry what a mask shows beyond the mesh's own boundary.

A mesh follows its mask with straight edges of several pixels, and a mask has a soft rim. The apron continues each
boundary triangle outwards by its own affine map, so that the rim and the corners that the polygon cuts off move along.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, TriangleMesh, bounding_box
from .boundary import SHARPEST_MITRE, Boundary
from .places import places

__all__ = ["ApronedMesh", "canvas_of", "usual_reach"]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]

# Widest apron, in edges of the mesh's boundary and at least in pixels: a polygon cuts off little more than that.
_REACH = 1.5
_LEAST_REACH = 12


def usual_reach(mesh: TriangleMesh) -> int:
    """Widest apron that a mesh needs to carry the corners that it cuts off its mask [px]."""
    edges = mesh.vertices[mesh.boundary_edges]
    length = float(np.median(np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)))
    return max(_LEAST_REACH, int(np.ceil(_REACH * length)))


def canvas_of(mesh: TriangleMesh, *, reach: int) -> PixelBox:
    """The pixels that a mesh with an apron up to ``reach`` [px] covers at rest; may exceed the picture."""
    return bounding_box(mesh.vertices, margin=int(np.ceil(reach * SHARPEST_MITRE)) + 4)


@dataclass(frozen=True, eq=False)
class ApronedMesh:
    """A mesh with its apron.

    Attributes:
        rest: positions at rest of the mesh's vertices, then of the apron's outer corners [px], shape [v + c, 2].
        triangles: those of the apron first, so that the mesh's own win where both cover a pixel; of a mesh with slits
            those of each strand's apron before that strand's own, shape [t, 3].
        sources: mesh vertices that lead each outer corner, shape [c, 6].
        weights: their weights, of sum 1, shape [c, 6].
    """

    rest: FloatArray
    triangles: IndexArray
    sources: IndexArray
    weights: FloatArray

    @classmethod
    def around(cls, mesh: TriangleMesh, alpha: NDArray[np.float32], canvas: PixelBox, *, reach: int) -> ApronedMesh:
        """Lay an apron wide enough for what is opaque around a mesh.

        Args:
            mesh: the body's mesh.
            alpha: opacity over ``canvas``, shape [canvas height, canvas width].
            canvas: from ``canvas_of``.
            reach: widest apron [px].
        """
        boundary = Boundary(mesh)
        wide = boundary.widths(alpha, canvas, float(reach))
        return cls._with_corners(mesh, boundary, wide)

    @classmethod
    def _with_corners(cls, mesh: TriangleMesh, boundary: Boundary, widths: FloatArray) -> ApronedMesh:
        outer = boundary.corners(widths)
        sources, weights = boundary.leading(outer)
        rest = np.concatenate([mesh.vertices, outer])
        triangles = np.concatenate([boundary.quads(len(mesh.vertices)), mesh.triangles])
        order = np.argsort(np.concatenate([np.tile(boundary.over(), 2), np.arange(len(mesh.triangles))]), kind="stable")
        return cls(rest, triangles[order], sources, weights)

    def positions(self, vertices: NDArray[np.float32]) -> FloatArray:
        """Positions of the vertices and outer corners [px], shape [v + c, 2], for moved mesh vertices [v, 2].

        Moves are added to the rest positions, so that what does not move stays exactly where it is.
        """
        count = len(vertices)
        moved = vertices - self.rest[:count].astype(np.float32)
        led = np.einsum("ck,ckx->cx", self.weights, moved[self.sources])
        return self.rest + np.concatenate([moved, led])

    def places_at_rest(
        self, positions: FloatArray, box: PixelBox, canvas: PixelBox
    ) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Column and row of a canvas at rest that each pixel of a box shows, far off it where the mesh is not.

        Args:
            positions: from ``positions`` [px], shape [v + c, 2].
            box: the pixels that are wanted.
            canvas: in whose pixels the places are told; pixel [0, 0] has its centre at (0, 0).

        Returns:
            Columns and rows, shape [box height, box width] each.
        """
        return places(positions, self.triangles, self.rest, box, canvas)
