"""Splats: moved pixels, split where the flow stretches them, to be set down where they land."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["Splats", "splats_of"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# A pixel is split where the flow stretches it more than this, and at most into this many parts along each side.
# Pictures stretched to 1.2 to 4 times their size keep 0.88 of a pixel and more everywhere; so they do with half the
# limit, with twice of it they have holes from 1.6 times on, and with two parts a side at 4 times.
_STRETCH_LIMIT = 1.3
_MOST_PARTS = 4
# Pixels moving apart faster than this are torn, not stretched: two bodies, or a body and what rests [px/px]. At half of
# it a stretch to 4 times counts as torn.
_TEAR = 4.0


@dataclass(frozen=True, eq=False)
class Splats:
    """Pieces of moved pixels, ready to be set down.

    Attributes:
        x, y: where each lands, pixel [0, 0] having its centre at (0, 0), shape [n].
        area: pixels that it covers after the motion, shape [n].
        weight: importance, shape [n].
        values: shape [n, c].
    """

    x: NDArray[np.float32]
    y: NDArray[np.float32]
    area: NDArray[np.float32]
    weight: NDArray[np.float32]
    values: NDArray[np.float32]


def splats_of(channels: FloatImage, flow: FloatImage, weights: FloatImage, moved: Mask) -> Splats:
    """Every moved pixel, split into parts where the flow stretches it over more than one.

    Args:
        channels: values, shape [h, w, c].
        flow: displacement [px], shape [h, w, 2].
        weights: importance, shape [h, w].
        moved: which pixels to take, shape [h, w].
    """
    height, width = moved.shape
    u, v = cv2.split(flow)
    (ux, vx), (uy, vy) = (_slopes(u, v, moved, axis) for axis in (1, 0))
    area = np.minimum(np.abs((1 + ux) * (1 + vy) - uy * vx), np.float32(_MOST_PARTS**2))
    limit = np.float32(_STRETCH_LIMIT**2)
    stretched = ((1 + ux) ** 2 + vx * vx > limit) | (uy * uy + (1 + vy) ** 2 > limit)
    x = u + np.arange(width, dtype=np.float32)
    y = v + np.arange(height, dtype=np.float32)[:, None]
    stretched &= moved
    whole = _picked(np.flatnonzero(moved & ~stretched), x, y, area, weights, channels)
    if not stretched.any():
        return whole
    row, column = np.nonzero(stretched)
    slopes = [slope[row, column] for slope in (ux, vx, uy, vy)]
    parts = _parts_of(_picked(np.flatnonzero(stretched), x, y, area, weights, channels), row, column, slopes, channels)
    return Splats(*(np.concatenate([getattr(whole, k), getattr(parts, k)]) for k in Splats.__annotations__))


def _picked(
    where: NDArray[np.int64], x: FloatImage, y: FloatImage, area: FloatImage, weights: FloatImage, channels: FloatImage
) -> Splats:
    """The whole pixels at flat indices."""
    planes = [plane.reshape(-1)[where] for plane in (x, y, area, weights)]
    return Splats(planes[0], planes[1], planes[2], planes[3], channels.reshape(-1, channels.shape[2])[where])


def _slopes(u: FloatImage, v: FloatImage, moved: Mask, axis: int) -> list[NDArray[Any]]:
    """Change of u and of v per pixel along an axis, each the mean over the neighbours that moved too, shape [h, w]."""
    ahead, behind = (np.s_[:, 1:], np.s_[:, :-1]) if axis == 1 else (np.s_[1:], np.s_[:-1])
    steps = [plane[ahead] - plane[behind] for plane in (u, v)]
    together = moved[ahead] & moved[behind]
    together &= steps[0] * steps[0] + steps[1] * steps[1] < np.float32(_TEAR**2)
    share = np.zeros_like(u)
    share[ahead] = together
    share[behind] += together
    share = 1 / np.maximum(share, np.float32(1))
    slopes = []
    for step in steps:
        step *= together
        total = np.zeros_like(u)
        total[ahead] = step
        total[behind] += step
        total *= share
        slopes.append(total)
    return slopes


def _parts_of(
    whole: Splats,
    row: NDArray[np.int64],
    column: NDArray[np.int64],
    slopes: list[NDArray[Any]],
    channels: FloatImage,
) -> Splats:
    """Stretched pixels as the grid of parts that each becomes."""
    ux, vx, uy, vy = slopes
    across, down = _count(1 + ux, vx), _count(uy, 1 + vy)
    count = across * down
    parent = np.repeat(np.arange(len(count)), count)
    part = np.arange(len(parent)) - np.repeat(np.cumsum(count) - count, count)
    dx = ((part % across[parent] + 0.5) / across[parent] - 0.5).astype(np.float32)
    dy = ((part // across[parent] + 0.5) / down[parent] - 0.5).astype(np.float32)
    return Splats(
        whole.x[parent] + dx + dx * ux[parent] + dy * uy[parent],
        whole.y[parent] + dy + dx * vx[parent] + dy * vy[parent],
        np.divide(whole.area, count, dtype=np.float32)[parent],
        whole.weight[parent],
        _between(channels, row[parent], column[parent], dx, dy),
    )


def _count(x: NDArray[np.float32], y: NDArray[np.float32]) -> NDArray[np.int64]:
    """Into how many parts a pixel is split along a side that became (x, y) long."""
    return np.clip(np.ceil(np.hypot(x, y) / _STRETCH_LIMIT), 1, _MOST_PARTS).astype(np.int64)


def _between(
    channels: FloatImage,
    row: NDArray[np.int64],
    column: NDArray[np.int64],
    dx: NDArray[np.float32],
    dy: NDArray[np.float32],
) -> NDArray[np.float32]:
    """Bilinear values beside pixel centres, shape [n, c]."""
    height, width = channels.shape[:2]
    next_row = np.clip(row + np.sign(dy).astype(np.int64), 0, height - 1)
    next_column = np.clip(column + np.sign(dx).astype(np.int64), 0, width - 1)
    across, down = np.abs(dx)[:, None], np.abs(dy)[:, None]
    near = channels[row, column] * (1 - across) + channels[row, next_column] * across
    far = channels[next_row, column] * (1 - across) + channels[next_row, next_column] * across
    return near * (1 - down) + far * down
