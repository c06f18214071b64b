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
# What is nearer to the hole than this sees too little of them [px].
_BLIND = 3.0
# Every so many pixels are looked at.
_STEP = 2
# Squares of so many of them count as one piece of border.
_CELL = 2
_FAINTEST = 1e-4
# Places that are so far apart have directions of their own [px].
_COARSE = 8


@dataclass(frozen=True, eq=False)
class Directions:
    """Pieces of the borders around a hole.

    Attributes:
        x, y: where they are [px], shape [e].
        tensor: products of their normals, xx, xy, yy, times their lengths, shape [e, 3].
    """

    x: FloatArray
    y: FloatArray
    tensor: FloatArray

    def at(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """The mean tensor at some places, by the square of nearness, its trace 1, shape [n, 3]; 0 without borders."""
        if not len(self.x):
            return np.zeros((len(x), 3), dtype=np.float32)
        far = np.square(x[:, None] - self.x) + np.square(y[:, None] - self.y) + np.float32(1)
        total = np.reciprocal(far, out=far) @ self.tensor
        return np.asarray(total / (total[:, :1] + total[:, 2:]), dtype=np.float32)

    def dispersion(self, hole: Mask) -> FloatImage:
        """Sine of the angle by which they differ in the mean from the way that most of them run, shape [h, w].

        Args:
            hole: where it is asked, shape [h, w]; elsewhere it means nothing.
        """
        asked = squares_with(hole, _COARSE)
        row, column = (each * np.float32(_COARSE) + (_COARSE - 1) / 2 for each in np.nonzero(asked))
        xx, xy, yy = self.at(column.astype(np.float32), row.astype(np.float32)).T
        smaller = (xx + yy - np.sqrt(np.square(xx - yy) + 4 * xy * xy)) / 2
        sine = np.zeros(asked.shape, dtype=np.float32)
        sine[asked] = np.sqrt(np.maximum(smaller, 0))
        size = asked.shape[1] * _COARSE, asked.shape[0] * _COARSE
        return cv2.resize(sine, size, interpolation=cv2.INTER_LINEAR)[: hole.shape[0], : hole.shape[1]]


def border_directions(labels: IntImage, hole: Mask) -> Directions:
    """Find the borders that are known near a hole.

    Args:
        labels: which area each pixel belongs to, shape [h, w].
        hole: where that is not known, shape [h, w].
    """
    full = labels.shape
    labels, hole = labels[::_STEP, ::_STEP], hole[::_STEP, ::_STEP]
    away = cv2.distanceTransform((~hole).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5) * _STEP
    near = (away > _BLIND) & (away <= _REACH)
    known, sigma = (~hole).astype(np.float32), _SMOOTHED / _STEP
    weight = np.maximum(cv2.GaussianBlur(known, (0, 0), sigma), np.float32(1e-3))
    # A border's pixels are in steps, which are no directions of its own: changes are averaged before they are squared.
    size = -(-labels.shape[1] // _CELL), -(-labels.shape[0] // _CELL)
    tensor = np.zeros((size[1], size[0], 3), dtype=np.float32)
    for k in np.unique(labels[near]):
        share = cv2.GaussianBlur((labels == k) * known, (0, 0), sigma) / weight
        right, down = (cv2.resize(each * near, size, interpolation=cv2.INTER_AREA) for each in gradients(share))
        tensor += np.stack([right * right, right * down, down * down], axis=-1)
    row, column = np.nonzero(tensor[..., 0] + tensor[..., 2] > _FAINTEST)
    y, x = (
        (each + 0.5) * length / count - 0.5 for each, length, count in zip((row, column), full, size[::-1], strict=True)
    )
    return Directions(x.astype(np.float32), y.astype(np.float32), tensor[row, column])


def squares_with(where: Mask, side: int) -> Mask:
    """Which squares of a picture have something in a mask, or are beside one that has, shape [h / side, w / side]."""
    height, width = (-(-length // side) for length in where.shape)
    padded = np.zeros((height * side, width * side), dtype=bool)
    padded[: where.shape[0], : where.shape[1]] = where
    some = padded.reshape(height, side, width, side).any(axis=(1, 3))
    return cv2.dilate(some.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
