"""How soft borders between areas are: a cloud fades into the sky, a roof does not.

Across each piece of a known border, colours pass from one side's to the other's. With t the share of the one, the
integral of t (1 - t) across tells over which way: a step blurred by a Gaussian of width s has s / sqrt(pi), wherever in
the profile it lies, and noise on both sides, which adds as much on either, is taken off. An outline between both is
neither one's colour nor the other's, which makes the integral small: then the border is sharp.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .flat_regions import FlatRegions
from .flatness import nearest_of

__all__ = ["border_softness"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float64]
Mask = NDArray[np.bool_]

# A profile reaches so far to either side; its ends, from here on, are the colours of both sides [px].
_REACH = 20
_BESIDE = 8
# Borders are looked at within this of the hole, so many of them at most.
_NEAR = 32.0
_MOST = 600
# Sides must differ by this much to tell.
_CONTRAST = 0.06
_BEYOND = 0.25
# Borders within the hole are asked so many at most, and carry on to what is nearest.
_ASKED = 600


def border_softness(picture: FloatImage, hole: Mask, regions: FlatRegions) -> FloatImage:
    """Widths of the Gaussians that would blur a sharp border as soft as those in a hole should be [px], shape [h, w].

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        hole: where colours are unknown, shape [h, w].
        regions: the areas.
    """
    on_border = (regions.aside < 1) & (regions.number != regions.second)
    wanted = _some(hole & on_border, _ASKED)
    away = cv2.distanceTransform((~hole).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    known = _some(~hole & (away <= _NEAR) & on_border, _MOST)
    result = np.zeros(hole.shape, dtype=np.float32)
    if not (len(wanted[0]) and len(known[0])):
        return result
    soft, sure = _measured(picture, hole, regions, known)
    known = known[0][sure], known[1][sure]
    soft = soft[sure]
    if not len(soft):
        return result
    found = _carried(soft, _pairs(regions, known), known, _pairs(regions, wanted), wanted)
    result[wanted] = found
    where = np.zeros(hole.shape, dtype=bool)
    where[wanted] = True
    return np.where(hole, result.ravel()[nearest_of(where)[1]], 0).astype(np.float32)


def _some(where: Mask, most: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    row, column = np.nonzero(where)
    step = 1 + len(row) // most
    return row[::step], column[::step]


def _pairs(regions: FlatRegions, at: tuple[NDArray[np.int64], NDArray[np.int64]]) -> NDArray[np.int32]:
    """The two areas of some borders, the lower first, shape [n, 2]."""
    return np.sort(np.stack([regions.number[at], regions.second[at]], axis=1), axis=1)


def _measured(
    picture: FloatImage, hole: Mask, regions: FlatRegions, at: tuple[NDArray[np.int64], NDArray[np.int64]]
) -> tuple[FloatArray, Mask]:
    """How soft some known borders are [px], and which of them could be measured, shape [n]."""
    row, column = at
    first = np.minimum(regions.number[at], regions.second[at])
    down, right = _normals(regions, at)
    steps = np.arange(-_REACH, _REACH + 1)
    y = (row[:, None] + down[:, None] * steps).astype(np.float32)
    x = (column[:, None] + right[:, None] * steps).astype(np.float32)
    colours = cv2.remap(picture, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(np.float64)
    known = cv2.remap((~hole).astype(np.float32), x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT) > 0.999
    nearest = np.rint(y).astype(int).clip(0, hole.shape[0] - 1), np.rint(x).astype(int).clip(0, hole.shape[1] - 1)
    number = regions.number[nearest]
    # Each side ends where its area does.
    second = np.maximum(regions.number[at], regions.second[at])
    fits = known & ((number == first[:, None]) | (number == second[:, None]))
    middle = _REACH
    low, high = fits.copy(), fits.copy()
    low[:, middle::-1] = np.logical_and.accumulate(fits[:, middle::-1], axis=1)
    low[:, middle + 1 :] = False
    high[:, middle:] = np.logical_and.accumulate(fits[:, middle:], axis=1)
    high[:, :middle] = False
    ends = [_far(side, order) for side, order in ((low, -steps), (high, steps))]
    long = (low.sum(axis=1) > _BESIDE) & (high.sum(axis=1) > _BESIDE)
    means = [_mean(colours, end) for end in ends]
    way = means[1] - means[0]
    length = np.linalg.norm(way, axis=1)
    share = np.einsum("nsc,nc->ns", colours - means[0][:, None], way) / np.maximum(length, 1e-6)[:, None] ** 2
    mixed = share * (1 - share)
    total = np.zeros(len(row))
    for side, end in zip((low, high), ends, strict=True):
        noise = (mixed * end).sum(axis=1) / np.maximum(end.sum(axis=1), 1)
        total += ((mixed - noise[:, None]) * side).sum(axis=1)
    smooth = (share[:, 2:] + share[:, 1:-1] + share[:, :-2]) / 3
    beyond = (np.abs(smooth - 0.5) > 0.5 + _BEYOND) & (low | high)[:, 1:-1]
    total[beyond.any(axis=1)] = 0
    return np.maximum(total, 0) * np.sqrt(np.pi), long & (length > _CONTRAST)


def _far(side: Mask, steps: NDArray[np.int64]) -> Mask:
    """The farther end of a side, shape [n, s]."""
    farthest = np.where(side, steps, 0).max(axis=1)
    return side & (steps > 0.6 * farthest[:, None])


def _mean(colours: FloatArray, where: Mask) -> FloatArray:
    return np.einsum("nsc,ns->nc", colours, where) / np.maximum(where.sum(axis=1), 1)[:, None]


def _normals(
    regions: FlatRegions, at: tuple[NDArray[np.int64], NDArray[np.int64]]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Unit vectors across borders, down and right, shape [n] each."""
    signed = cv2.GaussianBlur(regions.aside.clip(0, 3), (0, 0), 1.5)
    # From the border on, how far it is rises on both sides; its second derivative is largest across.
    xx, yy = (cv2.Sobel(signed, cv2.CV_32F, *way, ksize=5)[at] for way in ((2, 0), (0, 2)))
    xy = cv2.Sobel(signed, cv2.CV_32F, 1, 1, ksize=5)[at]
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    return np.sin(angle), np.cos(angle)


def _carried(
    soft: FloatArray,
    known_pairs: NDArray[np.int32],
    known: tuple[NDArray[np.int64], NDArray[np.int64]],
    wanted_pairs: NDArray[np.int32],
    wanted: tuple[NDArray[np.int64], NDArray[np.int64]],
) -> FloatArray:
    """Softness of the borders that are wanted, shape [n].

    By distance from where the same two areas meet; where that is not known, as sharp as the sharper of both is elsewhere.
    """
    far = np.square(wanted[0][:, None] - known[0]) + np.square(wanted[1][:, None] - known[1]) + 1.0
    weight = 1 / far
    same = (wanted_pairs[:, None] == known_pairs).all(axis=2)
    found = _weighted(weight * same, soft)
    alone = ~same.any(axis=1)
    if alone.any():
        either = [
            _weighted(weight[alone] * (known_pairs == wanted_pairs[alone, None, k : k + 1]).any(axis=2), soft)
            for k in (0, 1)
        ]
        found[alone] = np.minimum(*either)
    return found


def _weighted(weight: FloatArray, values: FloatArray) -> FloatArray:
    return np.asarray(weight @ values / np.maximum(weight.sum(axis=1), 1e-12))
