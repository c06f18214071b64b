"""Clicks that fall on a drawn line: they stand for what lies beside it.

Whoever clicks on a fold, a seam or an outline means the part that the line is drawn on, not the line.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .clicked_regions import Looks, is_backdrop
from .noise import noise_of, without_noise

__all__ = ["off_lines"]

Mask = NDArray[np.bool_]
Lab = NDArray[np.uint8]
Points = NDArray[np.int_]
_Side = tuple[Points, Mask]
"""A point beside a line, and the region in which it lies."""

_WIDEST = 7
"""What is narrower may be a line [px of the size at which clicks are weighed]."""
_LEAST_CONTRAST = 12.0
"""By so much a line is darker than what lies beside it, and by several times the noise [8-bit Lab]."""
_TIMES_NOISE = 3.0
_LONG = 3.0  # times its own width
_LINE_SHARE = 0.8  # of a region that is nothing but a line
_ALIKE = (20, 10, 10)  # by which light and shade change one colour [8-bit Lab]
_DIRECTIONS = 16
_SQUARE = np.ones((3, 3), np.uint8)


def off_lines(lab: Lab, at: Points, positive: NDArray[np.bool_], tolerance: int) -> tuple[Points, NDArray[np.bool_]]:
    """The points, with each point on the object that lies on a line moved off it: to both sides if they are alike.

    Where the sides differ, it moves to the side on which other points on the object lie, or that has their colour, to
    the one that is no backdrop, to the nearer one, or else to the larger one. A line between two backdrops is a thing
    of its own, such as a rope before the sky: points on it stay.

    Args:
        lab: 8-bit Lab, shape [h, w, 3].
        at: column and row of each point, shape [k, 2].
        positive: whether each point is on the object, shape [k].
        tolerance: how much colour may change from pixel to pixel within one region [8-bit Lab steps].

    Returns:
        columns and rows, shape [n, 2], and whether each is on the object, shape [n]; n is at least k.
    """
    lines = _thin_and_dark(lab)
    near = cv2.dilate(lines.astype(np.uint8), _SQUARE) > 0
    on_line = positive & near[at[:, 1], at[:, 0]]
    if not on_line.any():
        return at, positive
    looks, others = Looks(lab), at[~positive]
    certain = at[positive & ~on_line]
    known = [looks.region(each, others, tolerance) for each in certain]
    moved = [
        _beside(lab, looks, point, others, near, known, tolerance) if on else point[None]
        for point, on in zip(at, on_line, strict=True)
    ]
    return np.concatenate(moved), np.repeat(positive, [len(each) for each in moved])


def _thin_and_dark(lab: Lab) -> Mask:
    """Long thin areas that are darker than both of their sides."""
    noise = noise_of(lab)
    light = np.ascontiguousarray(without_noise(lab, noise)[..., 0])
    depth = cv2.morphologyEx(light, cv2.MORPH_BLACKHAT, np.ones((_WIDEST, _WIDEST), np.uint8))
    dark = (depth >= max(_LEAST_CONTRAST, _TIMES_NOISE * noise)).astype(np.uint8)
    _, labels, statistics, _ = cv2.connectedComponentsWithStats(dark, connectivity=8)
    long = np.hypot(statistics[:, cv2.CC_STAT_WIDTH], statistics[:, cv2.CC_STAT_HEIGHT]) >= _LONG * _WIDEST
    long[0] = False
    return long[labels]


def _beside(
    lab: Lab, looks: Looks, point: Points, others: Points, lines: Mask, known: list[Mask], tolerance: int
) -> Points:
    """The points beside a line for which a point on it stands, shape [1 or 2, 2]; itself where it is no line."""
    own = looks.region(point, others, tolerance)
    across = _across(point, lines)
    if across is None or not own.any() or (own & lines).sum() < _LINE_SHARE * own.sum():
        return point[None]
    sides = [(each, looks.region(each, others, tolerance)) for each in across]
    sides = [(each, region) for each, region in sides if region.any() and not is_backdrop(region)]
    sides = _preferred(lab, sides, known)
    if len(sides) < 2:
        return sides[0][0][None] if sides else point[None]
    (first, one), (second, two) = sides
    if _alike(lab, one, two):
        return np.stack([first, second])
    nearness = np.hypot(*(second - point)) - np.hypot(*(first - point))
    if abs(nearness) < 1:
        nearness = float(one.sum()) - float(two.sum())
    return (first if nearness >= 0 else second)[None]


def _preferred(lab: Lab, sides: list[_Side], known: list[Mask]) -> list[_Side]:
    """The sides that other points on the object share, else those of their colours, else all."""
    shared = [side for side in sides if any((side[1] & each).any() for each in known)]
    return shared or [side for side in sides if any(_alike(lab, side[1], each) for each in known)] or sides


def _alike(lab: Lab, first: Mask, second: Mask) -> bool:
    if not (first.any() and second.any()):
        return False
    colours = [np.median(lab[region].astype(np.float64), axis=0) for region in (first, second)]
    return bool((np.abs(colours[0] - colours[1]) <= _ALIKE).all())


def _across(point: Points, lines: Mask) -> tuple[Points, Points] | None:
    """The first pixels beside a line on the shortest way across it; None where it is too wide, or at the border."""
    height, width = lines.shape
    best, least = None, np.inf
    for angle in np.arange(_DIRECTIONS) * np.pi / _DIRECTIONS:
        ends = []
        for sign in (1, -1):
            steps = sign * np.arange(1, _WIDEST + 3)[:, None] * np.array([np.cos(angle), np.sin(angle)])
            way = point + np.rint(steps).astype(int)
            way = way[((way >= 0) & (way < (width, height))).all(axis=1)]
            free = way[~lines[way[:, 1], way[:, 0]]]
            if len(free):
                ends.append(free[0])
        if len(ends) == 2 and (length := float(np.hypot(*(ends[0] - ends[1])))) < least:
            best, least = (ends[0], ends[1]), length
    return best
