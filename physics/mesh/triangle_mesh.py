"""TriangleMesh: the simulated shape of one body, in pixels of the illustration."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import is_whole
from ..errors import InvalidInputError, require
from .boundary import boundary_edges, half_edges, on_boundary

__all__ = ["UNITS_ACROSS", "TriangleMesh"]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int32]

_FARTHEST = 1e12  # [px]: squares of lengths stay far from what a float can bear
_LARGEST_SIDE = 2**31 - 1

UNITS_ACROSS = 0.46
"""Diagonal of the largest part's box [unit].

Sizes that are chosen for parts are chosen in units that follow them, so that an empty margin around the same drawing
changes nothing. The number is that of the hair of the bundled example, whose box is 591 px across on a picture of
1280 px: there a unit is the picture's longest side.
"""


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """A planar triangle mesh over an illustration.

    Coordinates are pixels, x right and y down, pixel centres at integer + 0.5. Triangles wind so that the
    shoelace area ``0.5 * cross(b - a, c - a)`` computed on these y-down coordinates is negative, which is
    counter-clockwise in y-up terms. This is the one place where the convention is stated.

    Attributes:
        vertices: rest positions [px], float64, shape [v, 2]; may lie outside the picture.
        triangles: vertex indices, int32, shape [t, 3].
        width: width of the illustration [px].
        height: height of the illustration [px].

    Examples:
        >>> from physanimator.physics.mesh import TriangleMesh
        >>> mesh = TriangleMesh([[1, 1], [9, 1], [9, 9], [1, 9]], [[0, 1, 2], [0, 2, 3]], width=10, height=10)
        >>> mesh.areas.tolist(), len(mesh.edges), len(mesh.boundary_edges)
        ([32.0, 32.0], 5, 4)
    """

    vertices: FloatArray
    triangles: IndexArray
    width: int
    height: int

    def __post_init__(self) -> None:
        vertices = _array_of("vertices", self.vertices, np.float64, "[v, 2]")
        triangles = _array_of("triangles", self.triangles, np.int32, "[t, 3]")
        if vertices.ndim != 2 or vertices.shape[1] != 2 or len(vertices) < 3:
            raise InvalidInputError(f"vertices must have shape [v, 2] with v >= 3. Got: {vertices.shape}")
        if triangles.ndim != 2 or triangles.shape[1] != 3 or len(triangles) < 1:
            raise InvalidInputError(f"triangles must have shape [t, 3] with t >= 1. Got: {triangles.shape}")
        if not np.isfinite(vertices).all():
            raise InvalidInputError("vertices must be finite. Got: NaN or infinity")
        if triangles.min() < 0 or triangles.max() >= len(vertices):
            raise InvalidInputError(
                f"triangles must index the {len(vertices)} vertices. Got: {triangles.min()} to {triangles.max()}"
            )
        far = vertices[(np.abs(vertices) > _FARTHEST).any(axis=1)]
        require("vertices", far[:1], not len(far), f"pixel coordinates from -{_FARTHEST:g} to {_FARTHEST:g}")
        sides = (self.width, self.height)
        if not all(is_whole(side, 1, _LARGEST_SIDE) for side in sides):
            shown = " x ".join(str(side)[:30] for side in sides)
            raise InvalidInputError(f"width and height must be at least 1 px, and whole numbers. Got: {shown}")
        object.__setattr__(self, "width", int(self.width))
        object.__setattr__(self, "height", int(self.height))
        a, b, c = (vertices[triangles[:, k]] for k in range(3))
        signed = _signed_areas(a, b, c)
        if (signed == 0).any():
            raise InvalidInputError(f"triangles must have an area. Got: {(signed == 0).sum()} degenerate ones")
        flip = signed > 0
        triangles[flip] = triangles[flip][:, [0, 2, 1]]
        for name, array in (("vertices", vertices), ("triangles", triangles)):
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    @property
    def longest_side(self) -> float:
        """Length of the illustration's longer side [px]: the unit of length in the physics."""
        return float(max(self.width, self.height))

    @cached_property
    def areas(self) -> FloatArray:
        """Rest area of each triangle [px^2], shape [t]."""
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        return np.abs(_signed_areas(a, b, c))

    @cached_property
    def edges(self) -> IndexArray:
        """Every edge once, lower index first, shape [e, 2]."""
        return np.unique(np.sort(half_edges(self.triangles), axis=1), axis=0).astype(np.int32)

    @cached_property
    def boundary_edges(self) -> IndexArray:
        """Edges of exactly one triangle, in that triangle's winding, shape [b, 2]."""
        return boundary_edges(self.triangles)

    @cached_property
    def boundary_triangles(self) -> IndexArray:
        """The triangle to which each of ``boundary_edges`` belongs, shape [b]."""
        return np.tile(np.arange(len(self.triangles), dtype=np.int32), 3)[on_boundary(half_edges(self.triangles))]

    @cached_property
    def components(self) -> IndexArray:
        """Number of the connected component of each vertex, from 0, shape [v]."""
        from scipy.sparse import coo_matrix
        from scipy.sparse.csgraph import connected_components

        edges = self.edges
        graph = coo_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(len(self.vertices),) * 2)
        return connected_components(graph, directed=False)[1].astype(np.int32)

    @cached_property
    def content_hash(self) -> str:
        """Hexadecimal digest that is equal for equal meshes."""
        digest = hashlib.sha256()
        digest.update(np.array([self.width, self.height], dtype=np.int64).tobytes())
        digest.update(self.vertices.tobytes())
        digest.update(self.triangles.tobytes())
        return digest.hexdigest()

    def rescaled(self, width: int, height: int) -> TriangleMesh:
        """The same shape over the illustration at another size."""
        scale = np.array([width / self.width, height / self.height])
        return TriangleMesh(self.vertices * scale, self.triangles, width, height)


def _array_of(name: str, values: object, kind: type, shape: str) -> NDArray[Any]:
    try:
        return np.array(values, dtype=kind, order="C")
    except (TypeError, ValueError, OverflowError):
        raise InvalidInputError(f"{name} must be numbers of shape {shape}. Got: {values!r:.60}") from None


def _signed_areas(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    u, v = b - a, c - a
    return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
