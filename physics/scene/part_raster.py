"""One connected part of a body in cells, and which of them something that stands still covers or lies under."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from .scene import Body

__all__ = ["PartRaster"]

BoolArray = NDArray[np.bool_]

_ACROSS = 256  # cells along the longer side of the part


@dataclass(frozen=True, eq=False)
class PartRaster:
    """A connected part in square cells.

    Attributes:
        inside: cells of the part, shape [rows, columns].
        covered: those that something still is in front of, shape [rows, columns].
        resting: those that something still is behind, the backdrop apart, shape [rows, columns].
        corner: where the cells begin [px], shape [2].
        scale: cells a pixel.
    """

    inside: BoolArray
    covered: BoolArray
    resting: BoolArray
    corner: NDArray[np.float64]
    scale: float

    @classmethod
    def of(cls, body: Body, chosen: BoolArray) -> PartRaster:
        """The raster of the part that these vertices of a body make, shape [v]."""
        mesh = body.mesh
        part = mesh.vertices[chosen]
        corner, span = part.min(axis=0), np.ptp(part, axis=0)
        scale = _ACROSS / float(span.max())
        inside = np.zeros(np.ceil(span[::-1] * scale).astype(int) + 1, dtype=np.uint8)
        fixed = np.rint(((mesh.vertices - corner) * scale) * 16).astype(np.int32)
        for triangle in fixed[mesh.triangles[chosen[mesh.triangles[:, 0]]]]:
            cv2.fillConvexPoly(inside, triangle, 1, shift=4)
        shape = inside.view(bool)
        covered, resting = (_sampled(mask, shape, corner, scale) for mask in (body.cover, body.rests_on))
        return cls(shape, covered, resting, corner, scale)

    def at(self, cells: BoolArray, points: NDArray[np.float64]) -> BoolArray:
        """Whether points [px], shape [n, 2], lie in chosen cells or next to one, as those on an edge do, shape [n]."""
        cells = cv2.dilate(cells.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
        column, row = np.rint((points - self.corner) * self.scale).astype(int).T
        return np.asarray(cells[row.clip(0, cells.shape[0] - 1), column.clip(0, cells.shape[1] - 1)])


def _sampled(mask: BoolArray | None, shape: BoolArray, corner: NDArray[np.float64], scale: float) -> BoolArray:
    """A mask of the picture in the cells of the part; beyond the border its nearest pixel counts."""
    if mask is None:
        return np.zeros_like(shape)
    rows, columns = (
        ((np.arange(count) / scale + start).astype(int)).clip(0, limit - 1)
        for count, start, limit in zip(shape.shape, corner[::-1], mask.shape, strict=True)
    )
    return shape & mask[rows[:, None], columns]
