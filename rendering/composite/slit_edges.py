"""Edges of slits: where strands of one mesh part or overlap, pixels show the mean of what lies within them.

The edge of a part is soft by its own alpha. A slit goes through what is opaque, so that its sides would be stepped.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, bounding_box, interpolate
from .apron import ApronedMesh

__all__ = ["slit_vertices", "soften_slits"]

FloatImage = NDArray[np.float32]

_PARTS = 3  # along each side of a pixel
_UNEVEN = 0.75  # [px] by which places within a pixel come from apart in the drawing where an edge goes through it
_AT_REST = 0.01  # [px]
_NOWHERE = -1e4
_ROW = 4096  # places that are read at once


def slit_vertices(mesh: ApronedMesh) -> NDArray[np.int64]:
    """Numbers of vertices of a mesh, not of its apron, that share their place at rest with another."""
    own = mesh.rest[: len(mesh.rest) - len(mesh.sources)]
    _, inverse, times = np.unique(own, axis=0, return_inverse=True, return_counts=True)
    return np.flatnonzero(times[inverse.ravel()] > 1)


def soften_slits(
    drawn: FloatImage,
    box: PixelBox,
    *,
    mesh: ApronedMesh,
    points: NDArray[np.float64],
    slit: NDArray[np.int64],
    canvas: PixelBox,
    parts: list[FloatImage],
) -> None:
    """Average the pixels through which an edge of a slit goes, in place.

    Args:
        drawn: the layer, shape [box height, box width, c].
        box: pixels that it covers.
        mesh: the layer's mesh.
        points: where its vertices are [px].
        slit: vertices along slits.
        canvas: pixels of the texture.
        parts: the texture in groups of channels.
    """
    around = bounding_box(points[slit], margin=2)
    left, top = max(around.left, box.left), max(around.top, box.top)
    width = min(around.left + around.width, box.left + box.width) - left
    height = min(around.top + around.height, box.top + box.height) - top
    if width <= 0 or height <= 0:
        return
    finer = PixelBox(left * _PARTS, top * _PARTS, (left + width) * _PARTS, (top + height) * _PARTS)
    away = interpolate(points * _PARTS, mesh.triangles, mesh.rest - points, finer, fill=_NOWHERE)
    away = away.reshape(2, height, _PARTS, width, _PARTS).transpose(0, 1, 3, 2, 4).reshape(2, height, width, -1)
    uneven = (away.max(axis=3) - away.min(axis=3) > _UNEVEN).any(axis=0)
    moved = ((np.abs(away) > _AT_REST) & (away > _NOWHERE)).any(axis=(0, 3))
    row, column = np.nonzero(uneven & moved)
    if not len(row):
        return
    within = (np.arange(_PARTS) + 0.5) / _PARTS - 0.5
    x = away[0, row, column] + (column + left - canvas.left)[:, None] + np.tile(within, _PARTS)
    y = away[1, row, column] + (row + top - canvas.top)[:, None] + np.repeat(within, _PARTS)
    values = np.concatenate([_read(part, x, y) for part in parts], axis=2).mean(axis=1)
    drawn[row + top - box.top, column + left - box.left] = values


def _read(texture: FloatImage, x: NDArray[np.floating], y: NDArray[np.floating]) -> FloatImage:
    """Values of a texture at places, shape [n, k, c] for places of shape [n, k]."""
    count = x.size
    rows = -(-count // _ROW)
    maps = [np.full(rows * _ROW, _NOWHERE, dtype=np.float32) for _ in range(2)]
    for each, places in zip(maps, (x, y), strict=True):
        each[:count] = places.ravel()
    x_map, y_map = (each.reshape(rows, _ROW) for each in maps)
    read = cv2.remap(texture, x_map, y_map, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=0)
    return np.asarray(read.reshape(rows * _ROW, -1)[:count].reshape(*x.shape, -1), dtype=np.float32)
