"""Splatting: amounts set down between pixels, each shared among the four pixels around its place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["splat"]


def splat(
    x: NDArray[np.floating[Any]],
    y: NDArray[np.floating[Any]],
    amounts: Sequence[NDArray[np.float64]],
    shape: tuple[int, int],
) -> list[NDArray[np.float64]]:
    """Share amounts among the four pixels around each landing place.

    Args:
        x, y: landing places, pixel [0, 0] having its centre at (0, 0), shape [n].
        amounts: what each brings, shape [n] each.
        shape: height and width of the picture [px].

    Returns:
        One plane of shape [h, w] for each of the amounts; what falls outside is lost.
    """
    from scipy.sparse import csr_array

    height, width = shape
    left, top = np.floor(x), np.floor(y)
    visible = (left >= -1) & (left < width) & (top >= -1) & (top < height)
    if not visible.all():
        x, y, left, top = (values[visible] for values in (x, y, left, top))
        amounts = [amount[visible] for amount in amounts]
    # A frame of one pixel around the picture takes what falls just outside.
    stride = width + 2
    first = ((top.astype(np.int32) + 1) * stride + 1) + left.astype(np.int32)
    cells = first[:, None] + np.array([0, 1, stride, stride + 1], dtype=np.int32)
    right, lower = (x - left).astype(np.float64), (y - top).astype(np.float64)
    shares = np.empty(cells.shape)
    for column, row in enumerate((1 - lower, lower)):
        np.multiply(row, right, out=shares[:, 2 * column + 1])
        np.subtract(row, shares[:, 2 * column + 1], out=shares[:, 2 * column])
    starts = np.arange(0, cells.size + 1, 4, dtype=np.int32)
    matrix = csr_array((shares.reshape(-1), cells.reshape(-1), starts), shape=(len(x), (height + 2) * stride))
    landed = matrix.T @ np.stack(amounts, axis=1)
    return [landed[:, k].reshape(height + 2, stride)[1:-1, 1:-1] for k in range(len(amounts))]
