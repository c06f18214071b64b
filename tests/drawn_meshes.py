"""Textured triangles drawn as graphics cards draw them: one after another, bilinear, straight alpha laid over."""

from __future__ import annotations

import cv2
import numpy as np

__all__ = ["draw_mesh"]


def draw_mesh(
    canvas: np.ndarray, vertices: np.ndarray, triangles: np.ndarray, places: np.ndarray, texture: np.ndarray
) -> None:
    """Lay a mesh over an opaque or transparent picture, in place.

    Args:
        canvas: premultiplied RGBA in 0 to 1, shape [h, w, 4].
        vertices: in pixels of the canvas, y down, shape [v, 2].
        triangles: shape [t, 3].
        places: of the vertices in the texture, 0 to 1 across and down, shape [v, 2].
        texture: straight RGBA, uint8, shape [h, w, 4].
    """
    found = [_fragments(vertices[each], places[each], canvas.shape) for each in triangles]
    pixel = np.concatenate([each[0] for each in found])
    place = np.concatenate([each[1] for each in found])
    if not len(pixel):
        return
    where = (place * texture.shape[1::-1] - 0.5).astype(np.float32)
    colours = texture.astype(np.float32) / 255
    shown = np.concatenate([_read(colours, where[k : k + 8192]) for k in range(0, len(where), 8192)])
    shown[:, :3] *= shown[:, 3:]
    flat = canvas.reshape(-1, 4)
    turns = _turns(pixel)
    for turn in range(turns.max() + 1):
        now = np.flatnonzero(turns == turn)
        flat[pixel[now]] = shown[now] + (1 - shown[now, 3:]) * flat[pixel[now]]


def _read(colours: np.ndarray, where: np.ndarray) -> np.ndarray:
    column, row = (np.ascontiguousarray(each).reshape(-1, 1) for each in where.T)
    return cv2.remap(colours, column, row, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).reshape(-1, 4)


def _turns(pixel: np.ndarray) -> np.ndarray:
    """How many fragments of the same pixel came before each."""
    order = np.argsort(pixel, kind="stable")
    starts = np.concatenate([[True], np.diff(pixel[order]) != 0])
    first = np.maximum.accumulate(np.where(starts, np.arange(len(pixel)), 0))
    turns = np.empty(len(pixel), dtype=np.int64)
    turns[order] = np.arange(len(pixel)) - first
    return turns


def _fragments(corners: np.ndarray, places: np.ndarray, shape: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Pixels whose centres a triangle covers, a centre on an edge once, and their places in the texture."""
    low = np.maximum(np.floor(corners.min(axis=0) - 0.5), 0).astype(int)
    high = np.minimum(np.ceil(corners.max(axis=0) + 0.5), shape[1::-1]).astype(int)
    if (low >= high).any():
        return np.zeros(0, dtype=np.int64), np.zeros((0, 2))
    y, x = np.mgrid[low[1] : high[1], low[0] : high[0]]
    weights, inside = [], np.ones(x.shape, dtype=bool)
    area = _beside(corners[0], corners[1], *corners[2])
    if area == 0:
        return np.zeros(0, dtype=np.int64), np.zeros((0, 2))
    for k in range(3):
        a, b = corners[(k + 1) % 3], corners[(k + 2) % 3]
        weight = _beside(a, b, x + 0.5, y + 0.5) / area
        way = (b - a) * np.sign(area)
        upper = way[1] < 0 or (way[1] == 0 and way[0] > 0)
        inside &= (weight > 0) | ((weight == 0) & upper)
        weights.append(weight)
    share = np.stack(weights, axis=-1)[inside]
    return (y * shape[1] + x)[inside].astype(np.int64), share @ places


def _beside(a: np.ndarray, b: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Twice the area of a triangle; the same to the last bit, but for its sign, from both sides of an edge."""
    if tuple(a) > tuple(b):
        return -_beside(b, a, x, y)
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
