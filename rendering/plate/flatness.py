"""Where drawn art is flat: areas that change evenly, with lines and soft edges between them."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from .wide_means import wide_mean

__all__ = ["FlatSurroundings", "flat_surroundings", "nearest_of"]

FloatImage = NDArray[np.float32]
IntImage = NDArray[np.int32]
Mask = NDArray[np.bool_]

# A pixel is flat where its surroundings deviate by no more than this many times the picture's noise, plus one level.
_DEVIATIONS = 2.0
_LEVEL = 1 / 255
# The noise is that of this share of the picture, the quietest.
_QUIET = 0.1
# Brushwork is even over a few pixels, but not over a square of this side [px].
_WIDE = 9
# A flat area has as many pixels as a square of this side, at least: texture has smaller ones by chance [px].
_LEAST = 8
# Lines and the soft edges beside them are no wider than twice this [px].
_LINE = 5.0
# How flat the surroundings are is a mean over about this distance [px].
_AROUND = 12.0


@dataclass(frozen=True, eq=False)
class FlatSurroundings:
    """What is flat around a hole.

    Attributes:
        share: how much of what is nearest is flat, 0..1, shape [h, w]; 0 in photographs and brushwork.
        plain: the picture with lines beside flat areas painted over by the nearest of them, RGB, shape [h, w, 3].
        flat: what is flat itself, shape [h, w].
        smooth: what is even over three pixels, flat or in a narrow gap, shape [h, w].
        noise: deviation of what is flat, in 0 to 1.
    """

    share: FloatImage
    plain: FloatImage
    flat: Mask
    smooth: Mask
    noise: float

    @property
    def cleanness(self) -> float:
        """1 without noise; 1/2 where it is a level of 255, and can be seen to be missing."""
        return 1 / (1 + (self.noise / _LEVEL) ** 2)


def flat_surroundings(picture: FloatImage, hole: Mask) -> FlatSurroundings:
    """Find flat areas by the picture's own noise.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        hole: true where colours are unknown, shape [h, w].
    """
    known = cv2.erode((~hole).astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    if not known.any():
        nothing = np.zeros(hole.shape, bool)
        return FlatSurroundings(np.zeros(hole.shape, np.float32), picture, nothing, nothing, 0.0)
    squares = picture * picture
    deviation = _deviation(picture, squares, 3)
    noise = float(np.quantile(deviation[known], _QUIET))
    most = _DEVIATIONS * noise + _LEVEL
    smooth = known & (deviation <= most + _LEVEL)
    if not smooth.any():
        return FlatSurroundings(np.zeros(hole.shape, np.float32), picture, smooth, smooth, noise)
    # Squares that reach into the hole see there what is beside it.
    continued = np.where(hole[..., None], picture.reshape(-1, 3)[nearest_of(smooth)[1]], picture)
    even = (_unevenness(continued, _WIDE) <= most).astype(np.uint8)
    flat = _large(smooth & (cv2.dilate(even, np.ones((_WIDE, _WIDE), np.uint8)) > 0))
    if not flat.any():
        return FlatSurroundings(np.zeros(hole.shape, np.float32), picture, flat, smooth, noise)
    away, nearest = nearest_of(flat)
    beside = ~hole & ~flat & (away <= _LINE)
    weight = np.maximum(cv2.blur(flat.astype(np.float32), (3, 3)), np.float32(1e-6))
    colours = cv2.blur(picture * flat[..., None], (3, 3)) / weight[..., None]
    plain = picture.copy()
    plain[beside] = colours.reshape(-1, 3)[nearest[beside]]
    share = _carried((flat | (beside & known)).astype(np.float32), known, hole)
    plain -= picture
    plain *= share[..., None]
    plain += picture
    return FlatSurroundings(share, plain, flat, smooth, noise)


def nearest_of(mask: Mask) -> tuple[FloatImage, IntImage]:
    """How far the nearest pixel of a mask is [px], and which one it is (row by row), shape [h, w]."""
    away, labels = cv2.distanceTransformWithLabels(
        (~mask).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    at = np.zeros(int(labels.max()) + 1, dtype=np.int32)
    at[labels[mask]] = np.flatnonzero(mask)
    return away, at[labels]


def _deviation(picture: FloatImage, squares: FloatImage, side: int) -> FloatImage:
    """Of the colours in a square around each pixel, shape [h, w]; their squares are given."""
    mean, variance = cv2.blur(picture, (side, side)), cv2.blur(squares, (side, side))
    mean *= mean
    variance -= mean
    return _root_of_largest(variance)


def _unevenness(picture: FloatImage, side: int) -> FloatImage:
    """Deviation in such a square from colours that change evenly across it, shape [h, w]."""
    at = np.arange(side, dtype=np.float32) - side // 2
    spread = float((at**2).mean())
    mean, rest = cv2.blur(picture, (side, side)), cv2.blur(picture * picture, (side, side))
    mean *= mean
    rest -= mean
    ramp, level = at / side, np.full(side, 1 / side, dtype=np.float32)
    for across, down in ((ramp, level), (level, ramp)):
        slope = cv2.sepFilter2D(picture, -1, across, down)
        slope *= slope
        slope /= spread
        rest -= slope
    return _root_of_largest(rest)


def _root_of_largest(squares: FloatImage) -> FloatImage:
    """Root of the largest of three channels, shape [h, w]."""
    red, green, blue = cv2.split(squares)
    return np.sqrt(np.maximum(np.maximum(np.maximum(red, green), blue), 0))


def _large(flat: Mask) -> Mask:
    _, parts, stats, _ = cv2.connectedComponentsWithStats(flat.astype(np.uint8), connectivity=4)
    enough = stats[:, cv2.CC_STAT_AREA] >= _LEAST**2
    enough[0] = False
    return np.asarray(enough[parts])


def _carried(flat: FloatImage, known: Mask, hole: Mask) -> FloatImage:
    """By how much what is flat outweighs what is not, carried on into what is not known, shape [h, w]."""
    weight = wide_mean(known.astype(np.float32), _AROUND)
    share = wide_mean(flat, _AROUND) / np.maximum(weight, np.float32(1e-6))
    share, known = np.clip(2 * share - 1, 0, 1), ~hole
    nearest = nearest_of(known)[1]
    return np.asarray(np.clip(cv2.GaussianBlur(share.ravel()[nearest], (0, 0), _AROUND / 2), 0, 1), dtype=np.float32)
