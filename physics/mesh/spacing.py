"""How large the triangles may be where: the local width of a shape, turned into a smoothly graded spacing."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from .masks import distance_to_zero

__all__ = ["GAP_FACTOR", "SpacingField", "spacing_field"]

FloatArray = NDArray[np.float64]

GAP_FACTOR = 1.5
"""Largest spacing beside a gap, in widths of the gap: beyond it, circumcircles reach over to the other side."""

# Layers of triangles that fit into one spacing: the lattice does not fall in with the outlines.
_LAYERS = 0.93
_GRADATION = 0.3
_LEVEL_RATIO = 1.25
_BLOCK = 2
_CELLS_A_FLOOR = 2.5
# A disc of radius r leaves a square corner uncovered up to 0.41 r away; such corners need no finer triangles.
_CORNER = 0.45
_TRIANGLE = np.sqrt(3) / 4


@dataclass(frozen=True, eq=False)
class SpacingField:
    """Wanted distance between neighbouring vertices.

    Attributes:
        values: spacing [px] at the cell centres of a grid, shape [rows, columns].
        cell: width of a cell [px].
    """

    values: FloatArray
    cell: int

    def at(self, points: FloatArray) -> FloatArray:
        """Spacing [px] at points [px], bilinear, shape [n, 2] -> [n]; outside of the grid its nearest value."""
        last = np.array(self.values.shape[::-1]) - 1
        index = np.clip(points / self.cell - 0.5, 0, last)
        low = np.minimum(index.astype(np.int64), np.maximum(last - 1, 0))
        high = np.minimum(low + 1, last)
        (u, v), values = (index - low).T, self.values
        upper = values[low[:, 1], low[:, 0]] * (1 - u) + values[low[:, 1], high[:, 0]] * u
        lower = values[high[:, 1], low[:, 0]] * (1 - u) + values[high[:, 1], high[:, 0]] * u
        return upper * (1 - v) + lower * v

    def expected_triangles(self, inside: NDArray[np.bool_]) -> float:
        """About how many triangles of these sizes fill a shape given by pixels, shape [h, w]."""
        fraction = _shrunk(inside, self.cell)
        return float(np.sum(fraction / self.values**2)) * self.cell**2 / _TRIANGLE


def spacing_field(inside: NDArray[np.bool_], *, spacing: float, floor: float, elements_across: float) -> SpacingField:
    """Spacing by local width: finer in thin parts and beside narrow gaps, changing slowly from place to place.

    Args:
        inside: the shape, with a frame of background at least ``spacing`` wide, shape [h, w].
        spacing: largest spacing [px].
        floor: smallest spacing [px].
        elements_across: how many elements a thin part shall have across.
    """
    cell = max(1, int(floor / _CELLS_A_FLOOR))
    grid = _shrunk(inside, cell) >= 0.5
    values = np.full(grid.shape, float(spacing))
    if floor < spacing:
        count = 1 + int(np.ceil(np.log(spacing / floor) / np.log(_LEVEL_RATIO)))
        levels = np.geomspace(floor, spacing, count)
        values = np.where(
            grid,
            _by_width(grid, levels, levels * elements_across / (2 * cell * _LAYERS)),
            _by_width(~grid, levels, levels / (GAP_FACTOR * 2 * cell)),
        )
        values, cell = _smallest_of_blocks(values, _BLOCK), cell * _BLOCK
        values = _limited(values, levels, _GRADATION * cell)
    return SpacingField(values, cell)


def _shrunk(inside: NDArray[np.bool_], cell: int) -> NDArray[np.float32]:
    """Which fraction of each square of so many pixels lies inside, shape [ceil(h / cell), ceil(w / cell)]."""
    height, width = inside.shape
    padded = np.pad(inside.astype(np.float32), ((0, -height % cell), (0, -width % cell)))
    size = padded.shape[1] // cell, padded.shape[0] // cell
    return np.asarray(cv2.resize(padded, size, interpolation=cv2.INTER_AREA), dtype=np.float32)


def _smallest_of_blocks(values: FloatArray, block: int) -> FloatArray:
    """The smallest value in each square of so many cells."""
    rows, columns = values.shape
    padded = np.pad(values, ((0, -rows % block), (0, -columns % block)), mode="edge")
    blocks = padded.reshape(padded.shape[0] // block, block, padded.shape[1] // block, block)
    return np.asarray(blocks.min(axis=(1, 3)))


def _by_width(shape: NDArray[np.bool_], levels: FloatArray, radii: FloatArray) -> FloatArray:
    """At each cell of a shape the largest level whose disc fits into the shape there, shape [rows, columns]."""
    depth = distance_to_zero(shape) - 0.5
    values = np.full(shape.shape, levels[0])
    left = shape.copy()
    for level, radius in zip(levels[:0:-1], radii[:0:-1], strict=True):
        core = depth >= radius
        if core.any():
            reached = left & (distance_to_zero(~core) <= (1 + _CORNER) * radius)
            values[reached] = level
            left &= ~reached
        if not left.any():
            break
    return values


def _limited(values: FloatArray, levels: FloatArray, growth: float) -> FloatArray:
    """The values lowered until none exceeds another by more than ``growth`` a cell of distance."""
    limited = values.copy()
    for level in levels[:-1]:
        small = limited <= level * 1.0001
        if small.any():
            np.minimum(limited, level + growth * distance_to_zero(~small), out=limited)
    return limited
