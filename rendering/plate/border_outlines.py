"""Outlines along the borders of areas that have been continued into a hole.

Where the border between two areas enters the hole, a drawn outline may run along it; then the border goes on with an
outline of that colour and width. It ends where the outline at its other end begins, or thins out if there is none.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import window_around
from .flat_regions import FlatRegions

__all__ = ["draw_outlines"]

FloatImage = NDArray[np.float32]
IntImage = NDArray[np.int32]
Mask = NDArray[np.bool_]

# A border's pixels, across.
_ON_BORDER = 1.0
# A border that is shorter or less deep in the hole carries no outline; this near to the rim it enters the hole [px].
_SHORTEST = 12
_DEEPEST = 5.0
_ENTERS = 3.0
# Areas whose colours differ by less than this are one area, seen on both sides of the part.
_CONTRAST = 0.1
# An outline is looked for along the known border up to this far from there, and so far to its sides [px].
_ALONG = 16.0
_ASIDE = 4.0
_SQUARE = np.ones((int(2 * _ASIDE) + 1,) * 2, np.uint8)
_ASLANT = 1.15
_FEWEST = 8
# It accompanies at least this share of the border, and its colours differ by no more than this.
_ACCOMPANIED = 0.75
# What is not flat has no outlines of its own: those beside it are the flat area's, if it has them along as much.
_OPEN = 0.4
_ALIKE = 0.12
# With one end alone an outline thins out over this share of its length.
_THINNING = 0.6


@dataclass(frozen=True, eq=False)
class _Outline:
    """Where an outline enters the hole: row and column, RGB, and its width [px]."""

    at: NDArray[np.float64]
    colour: NDArray[np.float32]
    width: float


def draw_outlines(
    picture: FloatImage,
    filled: FloatImage,
    hole: Mask,
    regions: FlatRegions,
    contrast: FloatImage,
    lines: tuple[FloatImage, Mask],
) -> FloatImage:
    """Draw the outlines of areas on through a hole.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3], with the lines that are known.
        filled: the same with the hole filled, shape [h, w, 3].
        hole: shape [h, w].
        regions: the areas and their borders.
        contrast: how much the colours on both sides of a border differ, shape [h, w].
        lines: by how much lines are darker than what is beside them, and where they are, both shape [h, w].

    Returns:
        RGB, shape [h, w, 3]; unchanged outside the hole.
    """
    ink, dark = lines
    closed = _closed(dark, hole, regions)
    depth = cv2.distanceTransform(hole.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    drawn = filled.copy()
    for pair, border in _borders(hole, regions):
        if (
            depth[border].max() < _DEEPEST
            or np.median(contrast[border]) < _CONTRAST
            or (0 in pair and closed[max(pair)] < _OPEN)
        ):
            continue
        whole = [k for k in pair if closed[k] > _ACCOMPANIED]
        ends = [
            outline
            for end in _parts(border & (depth <= _ENTERS), 1)
            if (outline := _outline_at(end, pair, whole, picture, ink, dark, hole, regions)) is not None
        ]
        if ends:
            _draw(drawn, border, hole, regions, ends)
    return drawn


def _borders(hole: Mask, regions: FlatRegions) -> Iterator[tuple[tuple[int, int], Mask]]:
    """Each border between two areas within the hole: their numbers, and its pixels, shape [h, w]."""
    on = hole & (regions.aside < _ON_BORDER)
    low, high = np.minimum(regions.number, regions.second), np.maximum(regions.number, regions.second)
    key = np.where(on & (high > low), low * regions.count + high, -1)
    for each in np.unique(key[key >= 0]):
        for part in _parts(key == each, _SHORTEST):
            yield (int(each) // regions.count, int(each) % regions.count), part


def _parts(mask: Mask, least: int) -> Iterator[Mask]:
    count, parts, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    for k in range(1, count):
        if stats[k, cv2.CC_STAT_AREA] >= least:
            yield parts == k


def _closed(dark: Mask, hole: Mask, regions: FlatRegions) -> NDArray[np.float64]:
    """The share of each area's known border that an outline accompanies, shape [k]; 0 for what is not flat."""
    border = ~hole & (regions.aside < _ON_BORDER)
    lined = cv2.dilate(dark.astype(np.uint8), _SQUARE)[border] > 0
    sides = np.concatenate([regions.number[border], regions.second[border]])
    length = np.bincount(sides, minlength=regions.count)
    share = np.bincount(sides, weights=np.concatenate([lined, lined]), minlength=regions.count) / np.maximum(length, 1)
    share[0] = 0
    return share


def _outline_at(
    end: Mask,
    pair: tuple[int, int],
    whole: list[int],
    picture: FloatImage,
    ink: FloatImage,
    dark: Mask,
    hole: Mask,
    regions: FlatRegions,
) -> _Outline | None:
    """The outline of the known border between two areas, or around a whole one, near where it enters the hole."""
    window = window_around(end, margin=int(_ALONG) + int(_ASIDE))
    end, known = end[window], ~hole[window]
    number, second = regions.number[window], regions.second[window]
    near = cv2.distanceTransform((~end).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5) <= _ALONG
    border = near & known & (regions.aside[window] < _ON_BORDER) & (number != second)
    between = np.isin(number, pair) & np.isin(second, pair)
    for wanted in (between, *((number == k) | (second == k) for k in whole)):
        found = _outline_along(border & wanted, picture[window], ink[window], dark[window], known)
        if found is not None:
            row, column = np.nonzero(end)
            at = np.array([row.mean() + window[0].start, column.mean() + window[1].start])
            return _Outline(at, *found)
    return None


def _outline_along(
    border: Mask, picture: FloatImage, ink: FloatImage, dark: Mask, known: Mask
) -> tuple[NDArray[np.float32], float] | None:
    """Colour and width of the line that accompanies a border, if there is one."""
    if border.sum() < _FEWEST or (cv2.dilate(dark.astype(np.uint8), _SQUARE)[border] > 0).mean() < _ACCOMPANIED:
        return None
    peak = float(np.median(cv2.dilate(ink, _SQUARE)[border]))
    beside = cv2.dilate(border.astype(np.uint8), _SQUARE) > 0
    core = picture[beside & (ink > 0.8 * peak)]
    if not len(core) or core.std(axis=0).max() > _ALIKE:
        return None
    # A line through the middle of a square covers its width times the square's side, or a little more aslant.
    share, some = (cv2.blur(each.astype(np.float32), _SQUARE.shape)[border] for each in (ink > peak / 2, known))
    width = float(np.median(share / np.maximum(some, np.float32(1e-3)))) * _SQUARE.shape[0] / _ASLANT
    return np.median(core, axis=0), max(width, 1.0)


def _draw(picture: FloatImage, border: Mask, hole: Mask, regions: FlatRegions, ends: list[_Outline]) -> None:
    """Draw one border's outline, in place."""
    window = window_around(border, margin=int(2 * _ASIDE))
    own = border[window]
    rows, columns = np.mgrid[window]
    away = np.stack([np.hypot(rows - end.at[0], columns - end.at[1]) for end in ends]).astype(np.float32)
    nearness = 1 / np.maximum(away, 1) ** 2
    nearness /= nearness.sum(axis=0)
    width = np.einsum("k,khw->hw", [end.width for end in ends], nearness)
    if len(ends) == 1:
        left = 1 - away[0] / max(float(away[0][own].max()), 1)
        width *= np.clip(left / _THINNING, 0, 1)
    colour = np.einsum("kc,khw->hwc", [end.colour for end in ends], nearness)
    near = cv2.dilate(own.astype(np.uint8), _SQUARE) > 0
    covered = np.clip(width / 2 + 0.5 - regions.aside[window], 0, 1) * np.minimum(width, 1) * regions.sure[window]
    share = np.where(near & hole[window], covered, 0)[..., None].astype(np.float32)
    picture[window] += share * (colour.astype(np.float32) - picture[window])
