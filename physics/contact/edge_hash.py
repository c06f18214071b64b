# mypy: ignore-errors
"""A spatial hash of boundary edges by their middles, in the contact kernel."""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import taichi as ti

from ..solver.kernel_types import any_value, vec2

__all__ = ["bucket", "cell_of", "fill_hash", "middle"]

_ROW_STRIDE = 19349663  # spreads the rows of cells over the hash (Teschner et al. 2003)


@ti.func
def cell_of(p: vec2, size: ti.f32):
    return ti.cast(ti.floor(p[0] / size), ti.i32), ti.cast(ti.floor(p[1] / size), ti.i32)


@ti.func
def bucket(x: ti.i32, y: ti.i32, count: ti.i32):
    """Bucket of a cell; neighbours in a row of cells have neighbouring buckets."""
    return (x + y * _ROW_STRIDE) & (count - 1)


@ti.func
def middle(surface: any_value, e: ti.i32):
    """Middle of an edge when the candidates were listed."""
    return vec2(surface.middles[e][0], surface.middles[e][1])


@ti.func
def fill_hash(surface: any_value, size: ti.f32):
    """Sort edges by the buckets of their middles (counting sort): those of k are order[heads[k]:heads[k + 1]]."""
    heads, order = ti.static(surface.heads, surface.order)
    for k in range(heads.shape[0]):
        heads[k] = 0
    for e in range(surface.edges.shape[0]):
        x, y = cell_of(middle(surface, e), size)
        k = bucket(x, y, heads.shape[0] - 1)
        order[e][1] = k
        heads[k] = heads[k] + 1
    total = 0
    for k in range(heads.shape[0]):
        total = total + heads[k]
        heads[k] = total
    for e in range(surface.edges.shape[0]):
        k = order[e][1]
        heads[k] = heads[k] - 1
        order[heads[k]][0] = e
