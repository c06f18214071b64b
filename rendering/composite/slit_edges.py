"""Edges of slits: where strands of one mesh part or overlap, pixels show the mean of what lies within them.

The edge of a part is soft by its own alpha. A slit goes through what is opaque, so that its sides would be stepped.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, interpolate
from .apron import ApronedMesh

__all__ = ["slit_vertices", "soften_slits"]

FloatImage = NDArray[np.float32]

_PARTS = 3  # along each side of a pixel
_UNEVEN = 0.75  # [px] by which places within a pixel come from apart in the drawing where an edge goes through it
_REACH = 16  # around the vertices of a slit [px]
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
    shown: tuple[NDArray[np.float32], NDArray[np.float32]],
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
        shown: column and row of the texture that each of them shows, shape [box height, box width] each.
        mesh: the layer's mesh.
        points: where its vertices are [px].
        slit: vertices along slits.
        canvas: pixels of the texture.
        parts: the texture in groups of channels.
    """
    for place in _places_of_edges(box, shown, points[slit]):
        finer = PixelBox(*(each * _PARTS for each in (place.left, place.top, place.right, place.bottom)))
        away = interpolate(points * _PARTS, mesh.triangles, mesh.rest - points, finer, fill=_NOWHERE)
        away = away.reshape(2, place.height, _PARTS, place.width, _PARTS)
        away = away.transpose(0, 1, 3, 2, 4).reshape(2, place.height, place.width, -1)
        uneven = (away.max(axis=3) - away.min(axis=3) > _UNEVEN).any(axis=0)
        moved = ((np.abs(away) > _AT_REST) & (away > _NOWHERE)).any(axis=(0, 3))
        row, column = np.nonzero(uneven & moved)
        if not len(row):
            continue
        within = (np.arange(_PARTS) + 0.5) / _PARTS - 0.5
        x = away[0, row, column] + (column + place.left - canvas.left)[:, None] + np.tile(within, _PARTS)
        y = away[1, row, column] + (row + place.top - canvas.top)[:, None] + np.repeat(within, _PARTS)
        values = np.concatenate([_read(part, x, y) for part in parts], axis=2).mean(axis=1)
        drawn[row + place.top - box.top, column + place.left - box.left] = values


def _places_of_edges(
    box: PixelBox, shown: tuple[NDArray[np.float32], NDArray[np.float32]], slit: NDArray[np.float64]
) -> list[PixelBox]:
    """Boxes around the pixels near a slit beside which others show another place of the drawing."""
    near = np.zeros((box.height, box.width), dtype=np.uint8)
    for x, y in np.rint(slit - (box.left, box.top)).astype(int):
        cv2.circle(near, (int(x), int(y)), _REACH, 1, -1)
    columns, rows = np.nonzero(near.any(axis=0))[0], np.nonzero(near.any(axis=1))[0]
    if not len(columns):
        return []
    window = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    edge = np.zeros((window[0].stop - window[0].start, window[1].stop - window[1].start), dtype=np.uint8)
    for plane in shown:
        across, along = (np.abs(np.diff(plane[window], axis=axis)) > 1 + _UNEVEN for axis in (0, 1))
        edge[1:] |= across
        edge[:, 1:] |= along
    edge = cv2.dilate(edge & near[window], np.ones((5, 5), np.uint8))
    _, _, stats, _ = cv2.connectedComponentsWithStats(cv2.dilate(edge, np.ones((9, 9), np.uint8)))
    left, top = box.left + window[1].start, box.top + window[0].start
    return [
        PixelBox(left + x, top + y, left + x + width, top + y + height) for x, y, width, height, _ in stats[1:].tolist()
    ]


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
