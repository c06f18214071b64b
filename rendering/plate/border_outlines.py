"""Outlines along the borders of areas that have been continued into a hole.

Where the border between two areas enters the hole, a drawn outline may run along it; then the border goes on with an
outline of that colour and width. It ends where the outline at its other end begins, or thins out if there is none.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import window_around
from .border_softness import most_unsure
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
_MARGIN = int(_ALONG + _ASIDE) + 4
_FEWEST = 8
# It accompanies at least this share of the border, and its colours differ by no more than this.
_ACCOMPANIED = 0.75
# What is not flat has no outlines of its own: those beside it are the flat area's, if it has them along as much.
_OPEN = 0.4
_ALIKE = 0.12
# With one end alone an outline thins out over this share of its length.
_THINNING = 0.6
# A line is as strong as its width is of that over which a Gaussian spreads it, so many times its deviation.
_SPREAD = np.float32(np.sqrt(2 * np.pi))


@dataclass(frozen=True, eq=False)
class _Outline:
    """Where an outline enters the hole: row and column, RGB, and its width [px]."""

    at: NDArray[np.float64]
    colour: NDArray[np.float32]
    width: float


@dataclass(frozen=True, eq=False)
class _Surroundings:
    """What is known around, each of shape [h, w] but for the picture: see :func:`draw_outlines`."""

    picture: FloatImage
    ink: FloatImage
    dark: Mask
    hole: Mask
    depth: FloatImage
    contrast: FloatImage
    number: IntImage
    second: IntImage
    aside: FloatImage
    unsure: FloatImage

    def within(self, window: tuple[slice, slice]) -> _Surroundings:
        return _Surroundings(*(getattr(self, field.name)[window] for field in fields(self)))


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
    depth = cv2.distanceTransform(hole.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    unsure = np.minimum(regions.unsure, most_unsure(depth))
    around = _Surroundings(
        picture, *lines, hole, depth, contrast, regions.number, regions.second, regions.aside, unsure
    )
    closed = _closed(around, regions.count)
    drawn = filled.copy()
    for pair, window, border in _borders(around, regions.count):
        if 0 in pair and closed[max(pair)] < _OPEN:
            continue
        near = around.within(window)
        if near.depth[border].max() < _DEEPEST or np.median(near.contrast[border]) < _CONTRAST:
            continue
        whole = [k for k in pair if closed[k] > _ACCOMPANIED]
        entering = (_outline_at(end, pair, whole, near) for end in _parts(border & (near.depth <= _ENTERS), 1))
        ends = [outline for outline in entering if outline is not None]
        if ends:
            _draw(drawn[window], border, near, ends)
    return drawn


def _borders(around: _Surroundings, count: int) -> Iterator[tuple[tuple[int, int], tuple[slice, slice], Mask]]:
    """Each border between two areas within the hole: their numbers, a window around, and its pixels in the window."""
    row, column = np.nonzero(around.hole & (around.aside < _ON_BORDER) & (around.number != around.second))
    one, other = around.number[row, column], around.second[row, column]
    key = np.minimum(one, other) * count + np.maximum(one, other)
    for each in np.unique(key):
        y, x = row[key == each], column[key == each]
        window = (
            slice(max(0, y.min() - _MARGIN), y.max() + _MARGIN),
            slice(max(0, x.min() - _MARGIN), x.max() + _MARGIN),
        )
        own = np.zeros(around.hole[window].shape, dtype=bool)
        own[y - window[0].start, x - window[1].start] = True
        for part in _parts(own, _SHORTEST):
            yield (int(each) // count, int(each) % count), window, part


def _parts(mask: Mask, least: int) -> Iterator[Mask]:
    count, parts, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    for k in range(1, count):
        if stats[k, cv2.CC_STAT_AREA] >= least:
            yield parts == k


def _closed(around: _Surroundings, count: int) -> NDArray[np.float64]:
    """The share of each area's known border that an outline accompanies, shape [k]; 0 for what is not flat."""
    border = ~around.hole & (around.aside < _ON_BORDER)
    lined = cv2.dilate(around.dark.astype(np.uint8), _SQUARE)[border] > 0
    sides = np.concatenate([around.number[border], around.second[border]])
    length = np.bincount(sides, minlength=count)
    share = np.bincount(sides, weights=np.concatenate([lined, lined]), minlength=count) / np.maximum(length, 1)
    share[0] = 0
    return share


def _outline_at(end: Mask, pair: tuple[int, int], whole: list[int], around: _Surroundings) -> _Outline | None:
    """The outline of the known border between two areas, or around a whole one, near where it enters the hole."""
    window = window_around(end, margin=_MARGIN)
    end, near = end[window], around.within(window)
    close = cv2.distanceTransform((~end).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5) <= _ALONG
    border = close & ~near.hole & (near.aside < _ON_BORDER) & (near.number != near.second)
    between = np.isin(near.number, pair) & np.isin(near.second, pair)
    for wanted in (between, *((near.number == k) | (near.second == k) for k in whole)):
        found = _outline_along(border & wanted, near)
        if found is not None:
            return _Outline(np.argwhere(end).mean(axis=0) + (window[0].start, window[1].start), *found)
    return None


def _outline_along(border: Mask, around: _Surroundings) -> tuple[NDArray[np.float32], float] | None:
    """Colour and width of the line that accompanies a border, if there is one."""
    lined = cv2.dilate(around.dark.astype(np.uint8), _SQUARE)[border] > 0
    if border.sum() < _FEWEST or lined.mean() < _ACCOMPANIED:
        return None
    peak = float(np.median(cv2.dilate(around.ink, _SQUARE)[border]))
    beside = cv2.dilate(border.astype(np.uint8), _SQUARE) > 0
    core = around.picture[beside & (around.ink > 0.8 * peak)]
    if not len(core) or core.std(axis=0).max() > _ALIKE:
        return None
    # A line through the middle of a square covers its width times the square's side, or a little more aslant.
    line, known = (each.astype(np.float32) for each in (around.ink > peak / 2, ~around.hole))
    share = cv2.blur(line, _SQUARE.shape)[border] / np.maximum(cv2.blur(known, _SQUARE.shape)[border], np.float32(1e-3))
    width = float(np.median(share)) * _SQUARE.shape[0] / _ASLANT
    return np.median(core, axis=0), max(width, 1.0)


def _draw(picture: FloatImage, border: Mask, around: _Surroundings, ends: list[_Outline]) -> None:
    """Draw one border's outline, in place."""
    near = around.hole & (cv2.dilate(border.astype(np.uint8), _SQUARE) > 0)
    row, column = np.nonzero(near)
    away = np.stack([np.hypot(row - end.at[0], column - end.at[1]) for end in ends])
    nearness = 1 / np.maximum(away, 1) ** 2
    nearness /= nearness.sum(axis=0)
    width = np.array([end.width for end in ends]) @ nearness
    if len(ends) == 1:
        left = 1 - away[0] / max(float(away[0][border[near]].max()), 1)
        width *= np.clip(left / _THINNING, 0, 1)
    colour = nearness.T @ np.stack([end.colour for end in ends])
    share = (
        np.clip(width / 2 + 0.5 - around.aside[near], 0, 1)
        * np.minimum(width, 1)
        * width
        / np.hypot(width, _SPREAD * around.unsure[near])
    )
    picture[near] += (share[:, None] * (colour - picture[near])).astype(np.float32)
