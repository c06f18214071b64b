"""The colours of flat areas, continued into a hole."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import window_around
from .blurring import blurred
from .border_softness import border_widths
from .channels import over_channels
from .flat_regions import FlatRegions

__all__ = ["paint_regions"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# A plane is fitted to an area's colours within this of the hole [px], to about so many; it counts where it leaves no
# more than this share of their deviation.
_PLANE = 0.4
_NEAR = 40.0
_MOST = 3000
_FEWEST = 30
# How far the plane may lead beyond the colours that are there, as a share of their range.
_BEYOND = 0.25


def paint_regions(
    picture: FloatImage, rest: FloatImage, hole: Mask, regions: FlatRegions
) -> tuple[FloatImage, FloatImage]:
    """Paint each flat area's part of a hole in its colours, up to borders as soft as those around.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        rest: the picture with the hole filled as if no area around were flat, shape [h, w, 3].
        hole: where colours are to be found, shape [h, w].
        regions: the areas.

    Returns:
        RGB, shape [h, w, 3], unchanged outside the hole; and how much the colours on both sides of a border differ
        along it, shape [h, w].
    """
    first, second = rest.copy(), rest.copy()
    beside = hole & (regions.aside < 1)
    for k in range(1, regions.count):
        own, next_to_own = hole & (regions.number == k), beside & (regions.second == k)
        wanted, source = own | next_to_own, regions.flat == k
        if not wanted.any():
            continue
        window = window_around(wanted, margin=int(_NEAR))
        if not source[window].any():
            window = window_around(wanted | source, margin=0)
        colours = _continued(picture[window], source[window], wanted[window])
        first[window][own[window]] = colours[own[window]]
        second[window][next_to_own[window]] = colours[next_to_own[window]]
    share = np.clip(np.float32(0.5) + regions.aside / 2, 0.5, 1)[..., None]
    sharp = np.where(hole[..., None], second + share * (first - second), picture)
    contrast = np.where(beside, np.sqrt(over_channels((first - second) ** 2)), 0)
    soft = blurred(sharp, border_widths(picture, hole, regions), hole | (regions.flat > 0))
    return np.where(hole[..., None], soft, picture), contrast


def _continued(picture: FloatImage, source: Mask, wanted: Mask) -> FloatImage:
    """One area's colours, shape [h, w, 3]: between its own ones, and as a plane if they are one."""
    away = cv2.distanceTransform((~wanted).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    trend, lowest, highest = _trend(picture, source, source & (away < _NEAR))
    between = _between(picture - trend, source)
    return np.clip(between + trend, lowest, highest)


def _between(picture: FloatImage, source: Mask) -> FloatImage:
    """Colours between those of a mask, from fine to coarse and back (pull and push), shape [h, w, 3]."""
    weight = source.astype(np.float32)
    return _pulled(picture * weight[..., None], weight)


def _pulled(total: FloatImage, weight: FloatImage) -> FloatImage:
    mean = total / np.maximum(weight, np.float32(1e-6))[..., None]
    if weight.min() >= 1 or max(weight.shape) <= 2:
        return mean
    size = (weight.shape[1] + 1) // 2, (weight.shape[0] + 1) // 2
    small_weight = cv2.resize(weight, size, interpolation=cv2.INTER_AREA)
    small = cv2.resize(total, size, interpolation=cv2.INTER_AREA)
    # Pixels count fully once a quarter of what they stand for is known.
    scale = np.minimum(1, 4 * small_weight) / np.maximum(small_weight, np.float32(1e-6))
    coarse = _pulled(small * scale[..., None], small_weight * scale)
    pushed = cv2.resize(coarse, weight.shape[::-1], interpolation=cv2.INTER_LINEAR)
    return np.asarray(pushed + weight[..., None] * (mean - pushed), dtype=np.float32)


def _trend(picture: FloatImage, source: Mask, near: Mask) -> tuple[FloatImage, FloatImage, FloatImage]:
    """A plane over the picture where colours are one, else 0, shape [h, w, 3]; the lowest and highest to lead to."""
    row, column = np.nonzero(near if near.sum() >= _FEWEST else source)
    step = 1 + len(row) // _MOST
    row, column = row[::step], column[::step]
    colours = picture[row, column]
    lowest, highest = colours.min(axis=0), colours.max(axis=0)
    beyond = np.float32(_BEYOND) * (highest - lowest)
    height, width = source.shape
    terms = np.stack([np.ones(len(row)), column / width - 0.5, row / height - 0.5], axis=1)
    found = np.linalg.lstsq(terms.T @ terms, terms.T @ colours, rcond=None)[0].astype(np.float32)
    left = np.abs(colours - terms.astype(np.float32) @ found).mean()
    if left > _PLANE * np.abs(colours - colours.mean(axis=0)).mean():
        found[1:] = 0
    across = np.linspace(-0.5, 0.5, width, endpoint=False, dtype=np.float32)[None, :, None]
    down = np.linspace(-0.5, 0.5, height, endpoint=False, dtype=np.float32)[:, None, None]
    trend = found[0] + found[1] * across + found[2] * down
    return trend, np.maximum(lowest - beyond, 0), np.minimum(highest + beyond, 1)
