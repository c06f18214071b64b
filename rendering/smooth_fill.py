"""Smooth continuation of colours into a hole."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["smooth_fill", "spread_colours"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# What a part bares first lies beside its edge, and looks like what is next to it.
_FILL_POWER = 5.0
_LARGEST_WINDOW = 600_000
# How deep in a hole the harmonic fill has taken over [px].
_DEPTH = 100.0
_SWEEPS = 30
# The plane is fitted to pixels this near to the hole [px], to no fewer and to about no more of them than these numbers.
_BESIDE = 6
_FEWEST = 30
_MOST = 4000
_REWEIGHTINGS = 12
# Colours that differ less than this are equally good.
_CLOSE = 0.004
_COARSEST = 8
_MEAN_OF_FOUR = np.array([[0, 1, 0], [1, 0, 1], [0, 1, 0]], dtype=np.float32) / 4


def smooth_fill(picture: FloatImage, hole: Mask) -> FloatImage:
    """Fill a hole smoothly: near its edge with the colours there, deep inside harmonically.

    What changes evenly all around, such as a sky, is continued as a plane, and the rest by distance.
    A harmonic fill alone lets colours from the far side of a narrow hole, often another part of the same figure,
    shine through to where the background will show; colours by distance alone meet in visible ridges.

    Args:
        picture: RGB, shape [h, w, 3].
        hole: where colours are to be found, shape [h, w].

    Returns:
        RGB, shape [h, w, 3]; unchanged outside the hole.
    """
    trend = _trend(picture, hole)
    near = np.where(hole[..., None], spread_colours(picture - trend, ~hole, hole, power=_FILL_POWER) + trend, picture)
    depth = cv2.distanceTransform(hole.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    share = np.minimum(depth / np.float32(_DEPTH), 1)[..., None]
    return near + share * (_harmonic(picture, hole) - near)


def _trend(picture: FloatImage, hole: Mask) -> FloatImage:
    """The plane of colours that most pixels beside a hole lie near, shape [h, w, 3] (least absolute deviations)."""
    height, width = hole.shape
    beside = cv2.dilate(hole.astype(np.uint8), np.ones((2 * _BESIDE + 1,) * 2, np.uint8)) > 0
    row, column = np.nonzero(beside & ~hole)
    if len(row) < _FEWEST:
        return np.zeros_like(picture)
    row, column = row[:: 1 + len(row) // _MOST], column[:: 1 + len(row) // _MOST]
    terms = np.stack([np.ones(len(row)), column / width - 0.5, row / height - 0.5], axis=1)
    colours = picture[row, column].astype(np.float64)
    weights = np.ones(len(row))
    for _ in range(_REWEIGHTINGS):
        weighted = terms * weights[:, None]
        plane = np.linalg.lstsq(weighted.T @ terms, weighted.T @ colours, rcond=None)[0]
        weights = 1 / np.maximum(np.linalg.norm(colours - terms @ plane, axis=1), _CLOSE)
    x = np.linspace(-0.5, 0.5, width, endpoint=False, dtype=np.float32)[None, :, None]
    y = np.linspace(-0.5, 0.5, height, endpoint=False, dtype=np.float32)[:, None, None]
    plane = plane.astype(np.float32)
    return np.asarray(plane[0] + plane[1] * x + plane[2] * y, dtype=np.float32)


def spread_colours(picture: FloatImage, known: Mask, wanted: Mask, *, power: float = 4.0) -> FloatImage:
    """Continue colours smoothly: the mean of the known ones, weighted by distance^-power.

    Args:
        picture: RGB, shape [h, w, 3].
        known: where colours may be taken from, shape [h, w]; those at the edge of ``wanted`` if any.
        wanted: where colours are to be found, shape [h, w].
        power: how much nearer colours count for more.

    Returns:
        The picture with the wanted colours, shape [h, w, 3]; unchanged where no colour is known.
    """
    if wanted.size > _LARGEST_WINDOW:
        return _spread_at_half_size(picture, known, wanted, power)
    edge = known & (cv2.dilate(wanted.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0)
    if not edge.any():
        edge = known
    if not edge.any():
        return picture
    filled = picture.copy()
    filled[wanted] = _weighted_by_distance(picture, edge, power)[wanted]
    return filled


def _weighted_by_distance(picture: FloatImage, known: Mask, power: float) -> FloatImage:
    """Mean of the known colours weighted by distance^-power at every pixel, as a convolution, shape [h, w, 3]."""
    from scipy import fft

    height, width = known.shape
    # Double precision: the weights span more than the range of single precision.
    y = np.minimum(np.arange(2 * height), 2 * height - np.arange(2 * height)).astype(np.float64)
    x = np.minimum(np.arange(2 * width), 2 * width - np.arange(2 * width)).astype(np.float64)
    kernel = fft.rfft2((y[:, None] ** 2 + x**2 + 0.5) ** (-power / 2))
    planes = [known.astype(np.float64), *(picture[..., k] * known.astype(np.float64) for k in range(3))]
    spread = [
        fft.irfft2(fft.rfft2(plane, s=(2 * height, 2 * width)) * kernel, s=(2 * height, 2 * width))[:height, :width]
        for plane in planes
    ]
    return (np.stack(spread[1:], axis=-1) / np.maximum(spread[0], 1e-13)[..., None]).astype(np.float32)


def _spread_at_half_size(picture: FloatImage, known: Mask, wanted: Mask, power: float) -> FloatImage:
    size = (wanted.shape[1] + 1) // 2, (wanted.shape[0] + 1) // 2
    weight = cv2.resize(known.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    total = cv2.resize(picture * known[..., None], size, interpolation=cv2.INTER_AREA)
    some = cv2.resize(wanted.astype(np.float32), size, interpolation=cv2.INTER_AREA) > 0
    small = spread_colours(total / np.maximum(weight, 1e-6)[..., None], (weight > 0.5) & ~some, some, power=power)
    large = cv2.resize(small, wanted.shape[::-1], interpolation=cv2.INTER_LINEAR)
    return np.where(wanted[..., None], large, picture)


def _harmonic(picture: FloatImage, hole: Mask) -> FloatImage:
    """The hole filled so that every pixel is the mean of its neighbours (Laplace), from coarse to fine."""
    if min(hole.shape) <= _COARSEST:
        known = picture[~hole]
        return np.where(hole[..., None], known.mean(axis=0) if len(known) else np.float32(0), picture)
    size = (hole.shape[1] + 1) // 2, (hole.shape[0] + 1) // 2
    weight = (~hole).astype(np.float32)
    known = cv2.resize(weight, size, interpolation=cv2.INTER_AREA)
    total = cv2.resize(picture * weight[..., None], size, interpolation=cv2.INTER_AREA)
    coarse = _harmonic(total / np.maximum(known, 1e-6)[..., None], known < 0.5)
    guess = cv2.resize(coarse, hole.shape[::-1], interpolation=cv2.INTER_LINEAR)
    filled = np.where(hole[..., None], guess, picture)
    for _ in range(_SWEEPS):
        mean = cv2.filter2D(filled, -1, _MEAN_OF_FOUR, borderType=cv2.BORDER_REPLICATE)
        np.copyto(filled, mean, where=hole[..., None])
    return filled
