"""Drawn lines between strands: from the notches between tips of hair upward along what is darker than its surroundings.

A path of least cost over the darkness of the picture, which never turns back towards a tip, follows a line over small
gaps; as far as there is a line on it, it is one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from scipy.sparse import csr_array

__all__ = ["Field", "darkness", "lines_from"]

FloatArray = NDArray[np.float64]
FloatImage = NDArray[np.float32]

_BLUR = 0.7  # [cells]
_WIDEST = 9  # drawn lines are narrower than this [cells]
# How much darker than its surroundings a line is, 0 to 1: the darkest lines of a part count in full, within bounds.
_DARKEST, _FAINTEST, _FULL = 0.97, 0.06, 0.25
_EVEN = 0.04  # cost of a cell on a line, of one off a line 1 more
_NEEDED = 0.5  # darkness that speaks for a line rather than against it
_GAP = 5.0  # by how much a path may be off a line before it is none, twice as many cells
_BESIDE = 6.0  # cells of an outline that a path keeps away from, which is dark along its whole length
_SHORTEST = 0.12  # length of a line as a share of the longest way from the root


@dataclass(frozen=True, eq=False)
class Field:
    """A part in cells.

    Attributes:
        inside: cells of the part, shape [rows, columns].
        ways: how far each is from the root along the shape [cells], shape [rows, columns].
        lines: how much each looks like one of a drawn line, 0 to 1, shape [rows, columns].
    """

    inside: NDArray[np.bool_]
    ways: FloatImage
    lines: FloatImage


def darkness(grey: FloatImage, inside: NDArray[np.bool_]) -> FloatImage:
    """How much each cell looks like one of a drawn line, 0 to 1, shape [rows, columns].

    Args:
        grey: the picture, 0 to 1, shape [rows, columns].
        inside: where the part is, shape [rows, columns].
    """
    blurred = cv2.GaussianBlur(grey, (0, 0), _BLUR)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (_WIDEST, _WIDEST))
    deeper = cv2.morphologyEx(blurred, cv2.MORPH_BLACKHAT, disc)
    full = np.clip(np.quantile(deeper[inside], _DARKEST), _FAINTEST, _FULL) if inside.any() else _FULL
    return np.asarray(np.clip(deeper / full, 0, 1), dtype=np.float32)


def lines_from(field: Field, notches: FloatArray, *, until: FloatArray) -> list[FloatArray]:
    """The drawn line that begins at each notch, as points [cells] from the notch on, shape [n, 2]; empty for none.

    Args:
        field: the part.
        notches: where lines may begin: x and y [cells], shape [k, 2].
        until: how near the root each may come [cells], shape [k].
    """
    from scipy.sparse.csgraph import dijkstra
    from scipy.spatial import cKDTree

    allowed = field.inside & (field.ways >= until.min()) & _off_the_outline(field.inside, notches)
    cells = np.flatnonzero(allowed)
    number = np.full(allowed.size, -1)
    number[cells] = np.arange(len(cells))
    if not len(cells):
        return [np.zeros((0, 2))] * len(notches)
    rows, columns = np.unravel_index(cells, allowed.shape)
    _, seeds = cKDTree(np.stack([columns, rows], axis=1)).query(notches)
    graph = _upward(field, number)
    costs, before, source = dijkstra(graph, indices=seeds, min_only=True, return_predecessors=True)
    limit = np.zeros(len(cells))
    limit[seeds] = until
    ends = _ends(field, cells, (costs, before, source), limit)
    lines = []
    for seed in seeds:
        trail: list[int] = []
        cell = ends.get(int(seed), -1)
        while cell >= 0:
            trail.append(cell)
            cell = int(before[cell])
        along = np.array(trail[::-1], dtype=int)
        lines.append(np.stack([columns[along], rows[along]], axis=1).astype(np.float64))
    return lines


def _off_the_outline(inside: NDArray[np.bool_], notches: FloatArray) -> NDArray[np.bool_]:
    """Cells that are no part of an outline, or near a notch."""
    room = cv2.distanceTransform(np.pad(inside, 1).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1]
    near = np.zeros(inside.shape, dtype=np.uint8)
    for x, y in np.rint(notches).astype(int):
        cv2.circle(near, (int(x), int(y)), int(2.5 * _BESIDE), 1, -1)
    return np.asarray((room > _BESIDE) | (near > 0))


def _upward(field: Field, number: NDArray[np.integer]) -> csr_array:
    """Cost of the way from each cell to those of its neighbours that are nearer the root, [n, n]."""
    from scipy.sparse import coo_array

    rows, columns = field.inside.shape
    grid = number.reshape(rows, columns)
    starts, ends, costs = [], [], []
    for down, aside in ((0, 1), (1, 0), (1, 1), (1, -1)):
        here = (slice(0, rows - down), slice(max(0, -aside), columns - max(0, aside)))
        there = (slice(down, rows), slice(max(0, aside), columns - max(0, -aside)))
        for one, other in ((here, there), (there, here)):
            good = (grid[one] >= 0) & (grid[other] >= 0) & (field.ways[other] < field.ways[one])
            starts.append(grid[one][good])
            ends.append(grid[other][good])
            costs.append(np.hypot(down, aside) * (_EVEN + 1 - field.lines[other][good]))
    size = int(number.max()) + 1
    pairs = np.concatenate(starts), np.concatenate(ends)
    return coo_array((np.concatenate(costs), pairs), shape=(size, size)).tocsr()


def _ends(
    field: Field,
    cells: NDArray[np.integer],
    found: tuple[FloatArray, NDArray[np.integer], NDArray[np.integer]],
    limit: FloatArray,
) -> dict[int, int]:
    """For each notch the cell up to which most speaks for a line, if that is far enough."""
    costs, before, source = found
    ways, shortest = field.ways.ravel()[cells], _SHORTEST * float(field.ways[field.inside].max())
    reached = np.flatnonzero(np.isfinite(costs) & (before >= 0))
    reached = reached[ways[reached] >= limit[source[reached]]]
    order = reached[np.argsort(costs[reached], kind="stable")]
    gains = field.lines.ravel()[cells[order]] - _NEEDED
    far = ways[source[order]] - ways[order] >= shortest
    score, highest = [-math.inf] * len(cells), [-math.inf] * len(cells)
    for seed in np.unique(source[source >= 0]).tolist():
        score[seed] = highest[seed] = 0.0
    best: dict[int, tuple[float, int]] = {}
    rows = (each.tolist() for each in (order, before[order], source[order], gains, far))
    for cell, previous, origin, gain, enough in zip(*rows, strict=True):
        so_far = score[previous] + gain
        highest[cell] = max(highest[previous], so_far)
        if so_far < highest[cell] - _GAP:
            continue  # nothing beyond is reached either
        score[cell] = so_far
        if enough and so_far > best.get(origin, (0.0, -1))[0]:
            best[origin] = so_far, cell
    return {origin: cell for origin, (_, cell) in best.items()}
