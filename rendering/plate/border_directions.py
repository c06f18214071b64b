"""Which way the borders of areas run where they enter a hole, and how they lead on into it."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import gradients

__all__ = ["Directions", "border_directions", "squares_with"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float32]
IntImage = NDArray[np.int32]
Mask = NDArray[np.bool_]

# Borders are looked at within this of the hole, over about this length [px].
_REACH = 12.0
_SMOOTHED = 3.0
# Every so many pixels are looked at.
_STEP = 2
# Squares of so many of them count as one piece of border.
_CELL = 2
_FAINTEST = 1e-4
# In the hole directions are found for squares of this side [px], and between them by interpolation.
_SQUARE = 8
# So many pairs of a square and a piece are looked at at once, which the processor's cache holds.
_AT_ONCE = 1 << 17


@dataclass(frozen=True, eq=False)
class Directions:
    """The mean of the borders around, the nearer the more, at each square of a hole.

    Attributes:
        tensor: mean products of their normals, xx, xy, yy, its trace 1 or 0, shape [rows, columns, 3].
        shape: of the hole.
    """

    tensor: FloatImage
    shape: tuple[int, ...]

    @property
    def dispersion(self) -> FloatImage:
        """Sine of the angle by which borders differ in the mean from the way that most of them run, shape [h, w]."""
        xx, xy, yy = np.moveaxis(self.tensor, 2, 0)
        smaller = (xx + yy - np.sqrt(np.square(xx - yy) + 4 * xy * xy)) / 2
        size = self.tensor.shape[1] * _SQUARE, self.tensor.shape[0] * _SQUARE
        sine = cv2.resize(np.sqrt(np.maximum(smaller, 0)), size, interpolation=cv2.INTER_LINEAR)
        return sine[: self.shape[0], : self.shape[1]]

    def across(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """The way across borders at some places.

        Args:
            x, y: in the hole [px], shape [n].

        Returns:
            Products of the normal, xx, xy, yy, times the square of how much more borders run one way than the other,
            0..1; shape [n, 3].
        """
        column, row = ((each[None] - np.float32(_SQUARE / 2 - 0.5)) / np.float32(_SQUARE) for each in (x, y))
        xx, xy, yy = cv2.remap(self.tensor, column, row, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)[0].T
        # The tensor is the sum of the normal's, times the larger eigenvalue, and of the tangent's, times the smaller.
        spread = np.sqrt(np.square(xx - yy) + 4 * xy * xy)
        smaller = (xx + yy - spread) / 2
        return np.stack([spread * (xx - smaller), spread * xy, spread * (yy - smaller)], axis=1)


def border_directions(labels: IntImage, hole: Mask) -> Directions:
    """Find the borders that are known near a hole, and what they say within it.

    Args:
        labels: which area each pixel belongs to, shape [h, w].
        hole: where that is not known, shape [h, w].
    """
    x, y, pieces = _pieces(labels, hole)
    asked = squares_with(hole, _SQUARE)
    tensor = np.zeros((*asked.shape, 3), dtype=np.float32)
    if len(x):
        row, column = (each * np.float32(_SQUARE) + np.float32(_SQUARE / 2 - 0.5) for each in np.nonzero(asked))
        total, rows = np.empty((len(row), 3), dtype=np.float32), max(1, _AT_ONCE // len(x))
        for start in range(0, len(row), rows):
            some = slice(start, start + rows)
            far = np.square(column[some, None] - x)
            far += np.square(row[some, None] - y)
            far += 1
            far *= np.sqrt(far)  # the third power of the distance
            total[some] = np.reciprocal(far, out=far) @ pieces
        tensor[asked] = total / (total[:, :1] + total[:, 2:])
    return Directions(tensor, hole.shape)


def _pieces(labels: IntImage, hole: Mask) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Pieces of borders: where they are [px], shape [e], and products of their normals, shape [e, 3]."""
    full = hole.shape
    labels, hole = labels[::_STEP, ::_STEP], hole[::_STEP, ::_STEP]
    away = cv2.distanceTransform((~hole).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5) * _STEP
    near = ~hole & (away <= _REACH)
    known, sigma = (~hole).astype(np.float32), _SMOOTHED / _STEP
    weight = np.maximum(cv2.GaussianBlur(known, (0, 0), sigma), np.float32(1e-3))
    # Beside the hole they are seen in part.
    trust = near * weight
    # A border's pixels are in steps, which are no directions of its own: changes are averaged before they are squared.
    size = -(-labels.shape[1] // _CELL), -(-labels.shape[0] // _CELL)
    tensor = np.zeros((size[1], size[0], 3), dtype=np.float32)
    for k in np.unique(labels[near]):
        share = cv2.GaussianBlur((labels == k) * known, (0, 0), sigma) / weight
        right, down = (cv2.resize(each * trust, size, interpolation=cv2.INTER_AREA) for each in gradients(share))
        tensor += np.stack([right * right, right * down, down * down], axis=-1)
    row, column = np.nonzero(tensor[..., 0] + tensor[..., 2] > _FAINTEST)
    y, x = (
        (each + 0.5) * length / count - 0.5 for each, length, count in zip((row, column), full, size[::-1], strict=True)
    )
    return x.astype(np.float32), y.astype(np.float32), tensor[row, column]


def squares_with(where: Mask, side: int) -> Mask:
    """Which squares of a picture have something in a mask, or are beside one that has, shape [h / side, w / side]."""
    height, width = (-(-length // side) for length in where.shape)
    padded = np.zeros((height * side, width * side), dtype=bool)
    padded[: where.shape[0], : where.shape[1]] = where
    some = padded.reshape(height, side, width, side).any(axis=(1, 3))
    return cv2.dilate(some.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
