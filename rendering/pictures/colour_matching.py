"""Giving a picture the colours of another: mean and covariance in L*a*b* become the other's.

The linear map between two normal distributions that moves colours least (Pitie and Kokaram, "The linear
Monge-Kantorovitch linear colour mapping for example-based colour transfer", 2007).
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from .lab import lab_to_rgb, rgb_to_lab

__all__ = ["ColourStatistics", "colours_of", "common_weights", "with_colours"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float64]

# Statistics are of means over blocks, at most so many along a side: of colours, and not of how sharp lines are.
_BLOCKS = 128
# So many blocks tell a mean, and so many a covariance; what fewer tell counts less.
_FOR_MEAN, _FOR_COVARIANCE = 16.0, 64.0
# Variance that any colour may have: what is flat, or grey, in both pictures stays as it is [L*a*b* units^2].
_FLOOR = 1.0
# Contrast changes by no larger factor.
_MOST = 2.0
# Smaller changes of a mean [L*a*b* units] and of contrast are none.
_SAME_MEAN, _SAME_CONTRAST = 1e-3, 1e-4


@dataclass(frozen=True, eq=False)
class ColourStatistics:
    """How colours are spread in a picture.

    Attributes:
        mean: L*, a* and b*, shape [3].
        covariance: of these, shape [3, 3].
        blocks: how many blocks of pixels these come from; 0 where nothing is known.
    """

    mean: FloatArray
    covariance: FloatArray
    blocks: float

    def towards(self, other: ColourStatistics, share: float) -> ColourStatistics:
        """What lies between this and another, 0 to 1."""
        mean = self.mean + share * (other.mean - self.mean)
        covariance = self.covariance + share * (other.covariance - self.covariance)
        return ColourStatistics(mean, covariance, min(self.blocks, other.blocks))


def common_weights(*pictures: FloatImage, weights: FloatImage | None = None) -> FloatImage:
    """How much each pixel counts, shape [h, w]: as said, and nothing where a picture has no finite colour.

    Args:
        pictures: of one size, float32, shape [h, w, 3].
        weights: 0..1, shape [h, w]; 1 everywhere when None.
    """
    finite = np.logical_and.reduce([np.isfinite(picture).all(axis=2) for picture in pictures])
    if weights is None:
        return finite.astype(np.float32)
    return np.where(finite & np.isfinite(weights), np.clip(weights, 0, 1), 0).astype(np.float32)


def colours_of(picture: FloatImage, weights: FloatImage) -> ColourStatistics:
    """How colours are spread in a picture.

    Args:
        picture: RGB, float32 in 0..1, shape [h, w, 3].
        weights: how much each pixel counts, shape [h, w]; pixels that count nothing may be anything.
    """
    height, width = weights.shape
    size = max(1, round(width * _scale(width, height))), max(1, round(height * _scale(width, height)))
    # Means of pixels that count, and of no others.
    counted = np.where(weights[..., None] > 0, picture, 0) * weights[..., None]
    colours = cv2.resize(counted.astype(np.float32), size, interpolation=cv2.INTER_AREA).reshape(-1, 3)
    share = cv2.resize(weights, size, interpolation=cv2.INTER_AREA).reshape(-1)
    known = share > 1e-3
    if not known.any():
        return ColourStatistics(np.zeros(3), np.zeros((3, 3)), 0.0)
    colours, share = colours[known] / share[known, None], share[known].astype(np.float64)
    lab = rgb_to_lab(colours[None])[0].astype(np.float64)
    total = float(share.sum())
    mean = share @ lab / total
    apart = lab - mean
    return ColourStatistics(mean, (apart * share[:, None]).T @ apart / total, total)


def with_colours(
    picture: FloatImage, found: ColourStatistics, wanted: ColourStatistics, *, amount: float = 1.0
) -> FloatImage:
    """A picture whose colours are spread in another way.

    Args:
        picture: RGB, float32 in 0..1, shape [h, w, 3].
        found: what is known of its colours.
        wanted: how they should be spread.
        amount: share of the change that is made, 0..1.

    Returns:
        The picture itself where nothing is to change or nothing is known; pixels that are not finite stay as they are.
    """
    change = _change(found, wanted, amount)
    if change is None:
        return picture
    finite = np.asarray(np.isfinite(picture).all(axis=2))
    changed = lab_to_rgb(cv2.transform(rgb_to_lab(np.where(finite[..., None], picture, 0)), change))
    return np.where(finite[..., None], changed, picture).astype(np.float32, copy=False)


def _scale(width: int, height: int) -> float:
    return min(1.0, _BLOCKS / max(width, height))


def _change(found: ColourStatistics, wanted: ColourStatistics, amount: float) -> NDArray[np.float32] | None:
    """The affine map of colours, shape [3, 4]; None where it is none."""
    blocks = min(found.blocks, wanted.blocks)
    shift = min(1.0, blocks / _FOR_MEAN) * (wanted.mean - found.mean)
    contrast = min(1.0, blocks / _FOR_COVARIANCE) * (_contrast(found, wanted) - np.eye(3))
    if amount <= 0 or (np.abs(shift).max() < _SAME_MEAN and np.abs(contrast).max() < _SAME_CONTRAST):
        return None
    linear = np.eye(3) + amount * contrast
    offset = found.mean + amount * shift - linear @ found.mean
    return np.column_stack([linear, offset]).astype(np.float32)


def _contrast(found: ColourStatistics, wanted: ColourStatistics) -> FloatArray:
    """The symmetric matrix that gives colours the wanted covariance, within bounds, shape [3, 3]."""
    floor = _FLOOR * np.eye(3)
    root = _power(found.covariance + floor, 0.5)
    back = _power(found.covariance + floor, -0.5)
    return _bounded(back @ _power(root @ (wanted.covariance + floor) @ root, 0.5) @ back)


def _power(matrix: FloatArray, exponent: float) -> FloatArray:
    values, vectors = np.linalg.eigh((matrix + matrix.T) / 2)
    return np.asarray((vectors * np.maximum(values, 1e-6) ** exponent) @ vectors.T)


def _bounded(matrix: FloatArray) -> FloatArray:
    values, vectors = np.linalg.eigh((matrix + matrix.T) / 2)
    return np.asarray((vectors * np.clip(values, 1 / _MOST, _MOST)) @ vectors.T)
