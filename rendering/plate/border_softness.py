"""How soft borders between areas are: a cloud fades into the sky, a roof does not.

Across each piece of a known border, colours pass from one side's to the other's. With t the share of the one, the
integral of t (1 - t) across tells over which way: a step blurred by a Gaussian of deviation s has s / sqrt(pi),
wherever in the profile it lies. What noise adds is seen at the profile's ends. An outline between both is neither one's
colour nor the other's, and its border sharp.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .flat_regions import FlatRegions
from .flatness import nearest_of

__all__ = ["border_widths", "carried", "most_unsure"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Mask = NDArray[np.bool_]
Places = tuple[IntArray, IntArray]

# A profile reaches so far to either side, as long as it meets no third area, and no less than the second [px].
_REACH = 20
_SHORTEST = 8
# The last share of either side gives its colour; both must differ by so much.
_END = 0.4
_CONTRAST = 0.06
# What lies farther beyond both colours than this share of their difference is neither.
_BEYOND = 0.25
# Steepness is measured over so many pixels.
_STEEP = 4
# Borders are looked at within this of the hole [px], so many pieces of them, and carried on to as many in the hole.
_NEAR = 32.0
_PIECES = 300
# A border that is sharp where it is known looks no less sure than this [px]: of two wrong courses a sharp one is a
# drawing, and a blurred one a haze. Deep in the hole, where hardly anything is ever seen, it may look less sure by this
# share of the depth, and a soft one by as much as it is soft.
_UNSURE = 1.5
_DEEP = 0.1

# A blur changes nothing farther from the border than this [deviations].
_SEEN = 3


def border_widths(picture: FloatImage, hole: Mask, regions: FlatRegions) -> FloatImage:
    """How wide borders are in a hole: as soft as they are around it, and blurred where their course is not sure.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        hole: where colours are unknown, shape [h, w].
        regions: the areas.

    Returns:
        Deviation of the Gaussian that a sharp border is to be blurred by [px], shape [h, w]; 0 away from borders.
    """
    on_border = (regions.aside < 1) & (regions.number != regions.second)
    within, soft = hole & on_border, np.zeros(hole.shape, dtype=np.float32)
    if not within.any():
        return soft
    wanted = _some(within)
    soft[wanted] = _softness(picture, hole, regions, on_border, wanted)
    chosen = np.zeros(hole.shape, dtype=bool)
    chosen[wanted] = True
    depth = cv2.distanceTransform(hole.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    soft = soft.ravel()[nearest_of(chosen)[1]]
    width = np.hypot(soft, np.minimum(regions.unsure, np.maximum(most_unsure(depth), soft)))
    away = cv2.distanceTransform((~within).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    return np.where(hole & (away < _SEEN * width), width, 0).astype(np.float32)


def most_unsure(depth: FloatImage) -> FloatImage:
    """How unsure sharp borders may look so deep in a hole [px], shape [h, w]."""
    return np.maximum(np.float32(_UNSURE), np.float32(_DEEP) * depth)


def _softness(picture: FloatImage, hole: Mask, regions: FlatRegions, on_border: Mask, wanted: Places) -> FloatArray:
    """How soft some borders in the hole should be [px], shape [n]; 0 where nothing is known."""
    away = cv2.distanceTransform((~hole).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    known = _some(~hole & (away <= _NEAR) & on_border)
    if not len(known[0]):
        return np.zeros(len(wanted[0]))
    soft, told = _measured(picture, hole, regions, known)
    if not told.any():
        return np.zeros(len(wanted[0]))
    known = known[0][told], known[1][told]
    return carried(soft[told], known, _pairs(regions, known), wanted, _pairs(regions, wanted))


def _some(where: Mask) -> Places:
    row, column = np.nonzero(where)
    step = 1 + len(row) // _PIECES
    return row[::step], column[::step]


def _pairs(regions: FlatRegions, at: Places) -> NDArray[np.int32]:
    """The two areas of some borders, the lower first, shape [n, 2]."""
    return np.sort(np.stack([regions.number[at], regions.second[at]], axis=1), axis=1)


def _measured(picture: FloatImage, hole: Mask, regions: FlatRegions, at: Places) -> tuple[FloatArray, Mask]:
    """How soft known borders are [px], and which of them could be measured, shape [n]."""
    down, right = _normals(regions, at)
    steps = np.arange(-_REACH, _REACH + 1)
    y = (at[0][:, None] + down[:, None] * steps).astype(np.float32)
    x = (at[1][:, None] + right[:, None] * steps).astype(np.float32)
    colours = cv2.remap(picture, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(np.float64)
    unknown = cv2.remap(hole.astype(np.float32), x, y, cv2.INTER_LINEAR, borderValue=1) > 0
    number = regions.number[
        y.round().astype(int).clip(0, len(hole) - 1), x.round().astype(int).clip(0, hole.shape[1] - 1)
    ]
    fits = ~unknown & (number[..., None] == _pairs(regions, at)[:, None]).any(axis=2)
    sides = [_side(fits[:, ::-1])[:, ::-1], _side(fits)]
    lengths = [side.sum(axis=1) for side in sides]
    ends = [side & (np.abs(steps) > (1 - _END) * length[:, None]) for side, length in zip(sides, lengths, strict=True)]
    one, other = (_mean(colours, end) for end in ends)
    way = other - one
    contrast = np.linalg.norm(way, axis=1)
    share = np.einsum("nsc,nc->ns", colours - one[:, None], way) / np.maximum(contrast, 1e-6)[:, None] ** 2
    mixed = (share * (1 - share))[..., None]
    total = sum(
        ((mixed - _mean(mixed, end)[:, None])[..., 0] * side).sum(axis=1) for side, end in zip(sides, ends, strict=True)
    )
    even = (share[:, 2:] + share[:, 1:-1] + share[:, :-2]) / 3
    shown = sides[0] | sides[1]
    neither = (np.abs(even - 0.5) > 0.5 + _BEYOND) & shown[:, 1:-1]
    soft = np.where(neither.any(axis=1), 0, np.maximum(total, 0) * np.sqrt(np.pi))
    # What is not flat is not one colour: there a border is as soft as it is where it is steepest.
    steepest = (np.abs(share[:, _STEEP:] - share[:, :-_STEEP]) * shown[:, _STEEP:] * shown[:, :-_STEEP]).max(axis=1)
    mixed_side = (_pairs(regions, at) == 0).any(axis=1)
    steep = _STEEP / (np.sqrt(2 * np.pi) * np.maximum(steepest, 1e-6))
    soft = np.where(mixed_side, np.minimum(soft, steep), soft)
    return soft, (np.minimum(*lengths) > _SHORTEST) & (contrast > _CONTRAST)


def _side(fits: Mask) -> Mask:
    """One side of profiles, from the middle on as far as they fit, shape [n, s]."""
    side = np.zeros_like(fits)
    side[:, _REACH:] = np.logical_and.accumulate(fits[:, _REACH:], axis=1)
    return side


def _mean(values: FloatArray, where: Mask) -> FloatArray:
    """Over the places of each profile that are in a mask, shape [n, c]."""
    return np.asarray(np.einsum("nsc,ns->nc", values, where) / np.maximum(where.sum(axis=1), 1)[:, None])


def _normals(regions: FlatRegions, at: Places) -> tuple[FloatArray, FloatArray]:
    """Unit vectors across borders, down and right, shape [n] each."""
    # How far borders are rises on both of their sides: it bends most across them.
    far = cv2.GaussianBlur(np.minimum(regions.aside, np.float32(3)), (0, 0), 1.5)
    xx, xy, yy = (cv2.Sobel(far, cv2.CV_64F, *way, ksize=5)[at] for way in ((2, 0), (1, 1), (0, 2)))
    angle = np.arctan2(2 * xy, xx - yy) / 2
    return np.sin(angle), np.cos(angle)


def carried(
    soft: FloatArray, known: Places, known_pairs: NDArray[np.int32], wanted: Places, wanted_pairs: NDArray[np.int32]
) -> FloatArray:
    """Softness of the borders that are wanted, by distance from where the same two areas meet, shape [n].

    Where those do not, a border is as sharp as that of the sharper one: what lies in front has its own edge.
    """
    far = np.square(wanted[0][:, None] - known[0]) + np.square(wanted[1][:, None] - known[1]) + 1.0
    nearness = 1 / far**2
    same = (wanted_pairs[:, None] == known_pairs).all(axis=2)
    carried = _middle(nearness * same, soft)
    alone = ~same.any(axis=1)
    either = ((known_pairs == wanted_pairs[alone, None, k, None]).any(axis=2) for k in (0, 1))
    carried[alone] = np.minimum(*(_middle(nearness[alone] * each, soft) for each in either))
    return carried


def _middle(weight: FloatArray, values: FloatArray) -> FloatArray:
    """Medians, which a few profiles that met something else do not change, shape [n]; 0 without weight."""
    order = np.argsort(values)
    total = np.cumsum(weight[:, order], axis=1)
    half = total[:, -1:] / 2
    return np.where(half[:, 0] > 0, values[order][(total >= half).argmax(axis=1)], 0)
