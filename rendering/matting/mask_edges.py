"""Edges of masks: what lies along them, and whether they are hard."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import nearest_pixels

__all__ = [
    "CROSS",
    "FAINT",
    "LEAST_CONTRAST",
    "SOLID",
    "SQUARE",
    "WIDE",
    "edge_strength",
    "grown",
    "hard_edge",
    "inner_colour",
    "mean_near",
    "trusted",
]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

FAINT = 0.02
"""What a mask has at most where it shows nothing."""

SOLID = 0.95
"""And at least where nothing shows through."""

LEAST_CONTRAST = 0.1
"""Distance of colours from which on a share of both can be measured."""

SQUARE = np.ones((3, 3), np.uint8)
WIDE = np.ones((7, 7), np.uint8)
CROSS = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], np.uint8)

# The outermost pixels of a mask are above this in the mean along a hard edge, and near one half along a soft one.
_HARD = 0.75
# An edge is looked at over about this length [px].
_SIGMA = 5.0
_ALONG = 4.0
_AXES = ((1, 0), (0, 1))
# Up to the first difference a soft edge is trusted, from the second on the picture is.
_TRUST = 0.1
_DISBELIEF = 0.4


def grown(mask: Mask, shape: NDArray[np.uint8]) -> Mask:
    """The mask and what lies around it within a shape."""
    return cv2.dilate(mask.astype(np.uint8), shape) > 0


def hard_edge(mask: FloatImage, support: Mask) -> Mask:
    """Where the nearby edge of a mask is hard."""
    return mean_near(mask, support & grown(~support, CROSS))[0] > _HARD


def mean_near(values: FloatImage, where: Mask, *, sigma: float = _SIGMA) -> tuple[FloatImage, Mask]:
    """Mean value of the pixels in ``where`` within about ``sigma`` [px], and where there are any."""
    weight = where.astype(np.float32)
    total = cv2.GaussianBlur(weight, (0, 0), sigma)
    return cv2.GaussianBlur(values * weight, (0, 0), sigma) / np.maximum(total, 1e-6), total > 1e-3


def edge_strength(image: FloatImage, shape: Mask, *, apart_from: Mask | None = None) -> FloatImage:
    """How steeply the picture's colours change across the nearby edge of a shape [per px], shape [h, w].

    The change is averaged along the edge with its sign, so that texture cancels.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3], or with further channels.
        shape: whose edge is meant, shape [h, w].
        apart_from: another shape: where its edge is the same, the edge does not count; shape [h, w].
    """
    soft = cv2.GaussianBlur(shape.astype(np.float32), (0, 0), 1.0)
    line = _both_sides(shape)
    if apart_from is not None:
        line &= ~_both_sides(apart_from)
    on_line = np.flatnonzero(line)
    right, down = (cv2.Sobel(soft, -1, *axes).ravel()[on_line] for axes in _AXES)
    length = np.maximum(np.sqrt(right * right + down * down), np.float32(1e-6))
    along_x, along_y = (cv2.Sobel(image, -1, *axes, scale=1 / 8).reshape(-1, image.shape[2])[on_line] for axes in _AXES)
    across = np.zeros_like(image)
    across.reshape(-1, image.shape[2])[on_line] = (
        along_x * (right / length)[:, None] + along_y * (down / length)[:, None]
    )
    total = np.maximum(cv2.GaussianBlur(line.astype(np.float32), (0, 0), _ALONG), np.float32(1e-4))
    squares = [mean * mean for mean in cv2.split(cv2.GaussianBlur(across, (0, 0), _ALONG))]
    return np.asarray(np.sqrt(sum(squares[1:], start=squares[0])) / total, dtype=np.float32)


def _both_sides(shape: Mask) -> Mask:
    """The pixels next to the edge of a shape, inside and outside."""
    return grown(shape, CROSS) & grown(~shape, CROSS)


def inner_colour(image: FloatImage, support: Mask) -> FloatImage:
    """For every pixel the colour of the nearest one that lies at least two pixels inside."""
    depth = cv2.distanceTransform(support.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    ridge = cv2.dilate(depth, SQUARE) == depth
    core = support & ((depth >= 2) | ridge)
    return image.reshape(-1, 3).take(nearest_pixels(core)[1], axis=0)


def trusted(given: NDArray[np.float32], share: NDArray[np.float32]) -> NDArray[np.float32]:
    """How far the share that was measured counts beside a soft edge's own, 0 to 1.

    Small differences are the background's texture.
    """
    return np.asarray(np.clip((np.abs(share - given) - _TRUST) / (_DISBELIEF - _TRUST), 0, 1), dtype=np.float32)
