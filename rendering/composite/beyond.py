"""What of a layer lies beyond its aproned mesh: specks, wisps and wide glows, which go along with the mesh.

Squares are laid around these pixels. Each corner is led by the nearest vertices of the mesh, so that a glow moves and
turns with what it surrounds and nothing of a layer stays behind.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, TriangleMesh
from .places import NOWHERE

__all__ = ["Beyond"]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]
Mask = NDArray[np.bool_]

_NEAREST = 8
"""Vertices of the mesh that lead a corner."""

_DAMPING = 0.1
"""How soon a corner that is farther off than its leaders are apart only shifts with them and no longer turns."""

_SMALLEST = 8.0
"""Side of the squares at least, and otherwise the median edge of the mesh [px]."""

# Bicubic resampling reads so far around a pixel.
_BESIDE = 2


@dataclass(frozen=True, eq=False)
class Beyond:
    """Squares that the mesh leads.

    Attributes:
        rest: their corners at rest [px], shape [p, 2].
        triangles: two for each square, shape [t, 3].
        sources: vertices of the mesh that lead each corner, shape [p, k].
        weights: their weights, of sum 1, shape [p, k].
        own: where the mesh itself draws, at rest, over the layer's canvas, shape [canvas height, canvas width].
    """

    rest: FloatArray
    triangles: IndexArray
    sources: IndexArray
    weights: FloatArray
    own: Mask

    @classmethod
    def of(cls, mesh: TriangleMesh, left_over: Mask, covered: Mask, canvas: PixelBox) -> Beyond | None:
        """Squares around what is left over; None where nothing is.

        Args:
            mesh: of the body.
            left_over: pixels of the layer that the aproned mesh does not reach, shape [canvas height, canvas width].
            covered: those that it reaches, of the same shape.
            canvas: where these are.
        """
        if not left_over.any():
            return None
        edges = mesh.vertices[mesh.triangles[:, [0, 1]]]
        side = int(max(_SMALLEST, np.median(np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1))))
        size = np.ones((2 * _BESIDE + 1,) * 2, np.uint8)
        wide = cv2.dilate(np.pad(left_over, _BESIDE).astype(np.uint8), size)
        high, across = -(-wide.shape[0] // side), -(-wide.shape[1] // side)
        padded = np.zeros((high * side, across * side), np.uint8)
        padded[: wide.shape[0], : wide.shape[1]] = wide
        row, column = np.nonzero(padded.reshape(high, side, across, side).max(axis=(1, 3)))
        corner = row * (across + 1) + column
        squares = np.stack([corner, corner + 1, corner + across + 2, corner + across + 1], axis=1)
        kept, numbers = np.unique(squares, return_inverse=True)
        squares = numbers.reshape(squares.shape)
        origin = np.array([canvas.left - _BESIDE, canvas.top - _BESIDE], dtype=np.float64)
        rest = origin + side * np.stack([kept % (across + 1), kept // (across + 1)], axis=1)
        sources, weights = _leading(mesh.vertices, rest)
        triangles = np.concatenate([squares[:, [0, 1, 2]], squares[:, [0, 2, 3]]])
        # Right at the edge of the mesh both may draw, so that no seam opens between them.
        own = cv2.erode(covered.astype(np.uint8), size) > 0
        return cls(rest, triangles, sources, weights, own)

    def positions(self, shifts: NDArray[np.float32]) -> FloatArray:
        """Positions of the corners [px], shape [p, 2], for shifts of the mesh's vertices [px], shape [v, 2]."""
        return self.rest + np.einsum("pk,pkx->px", self.weights, shifts[self.sources])

    def without_own(self, places: NDArray[np.complex64]) -> NDArray[np.complex64]:
        """Places of the canvas, column + row i, far off it where the mesh itself draws at rest."""
        row, column = np.rint(places.imag).astype(np.int32), np.rint(places.real).astype(np.int32)
        height, width = self.own.shape
        there = (row >= 0) & (row < height) & (column >= 0) & (column < width)
        there[there] = self.own[row[there], column[there]]
        return np.where(there, np.complex64(complex(NOWHERE, NOWHERE)), places)


def _leading(vertices: NDArray[np.floating], points: FloatArray) -> tuple[IndexArray, FloatArray]:
    """Vertices that lead each point and their weights, shape [p, k] each: a damped moving least squares fit.

    Source: Schaefer, McPhail and Warren, "Image Deformation Using Moving Least Squares" (2006), affine, with the
    gradient damped by the distance that it is carried over.
    """
    from scipy.spatial import cKDTree

    count = min(_NEAREST, len(vertices))
    distance, sources = cKDTree(vertices).query(points, k=count)
    base = 1 / np.maximum(distance.reshape(-1, count), 1e-3) ** 2
    base /= base.sum(axis=1, keepdims=True)
    sources = sources.reshape(-1, count).astype(np.int64)
    leaders = np.asarray(vertices, dtype=np.float64)[sources]
    mean = np.einsum("pk,pkx->px", base, leaders)
    around, ahead = leaders - mean[:, None], points - mean
    spread = np.einsum("pk,pkx,pky->pxy", base, around, around)
    damped = _DAMPING * (ahead**2).sum(axis=1) + 1e-6
    gradient = np.linalg.solve(spread + damped[:, None, None] * np.eye(2), ahead[..., None])[..., 0]
    return sources, base * (1 + np.einsum("pkx,px->pk", around, gradient))
