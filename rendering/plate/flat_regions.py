"""Flat areas of drawn art continued into a hole: each as far as no other is nearer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import window_around
from .area_kinds import ending_at_edges, glimpses, wide_areas
from .area_votes import elected_areas
from .border_directions import border_directions
from .channels import over_channels
from .flatness import FlatSurroundings, nearest_of

__all__ = ["FlatRegions", "flat_regions"]

FloatImage = NDArray[np.float32]
IntImage = NDArray[np.int32]
Mask = NDArray[np.bool_]

# What is farther than this from every flat area is not flat; nearer are lines and the soft edges beside them [px].
_LINE = 5.0
# An area touches the hole along so much, at least; what lies this near to the hole touches it [px].
_CONTACT = 8
_TOUCH = 8.0
_MOST_REGIONS = 48
# Borders are rounded over this [px].
_ROUNDED = 3.0
# They may be off by this share of what the directions of those around would let them be off by.
_OFF = 0.25
# Areas whose colours differ by less are one; a line that is continued through the hole has an area's colours at its
# sides if they differ by less than the second.
_ALIKE = 0.06
_BESIDE = 0.2
# A line between an area and the rim is darker than the area by this. It is the area's own where it runs along more than
# the first share of where they meet, and such lines along less than the second of the whole rim.
_DARKER = 0.15
_ALL_ALONG = 0.8
_SELDOM = 0.5
# Areas are seen in narrow gaps where three quarters of what is around are flat: texture has each colour somewhere.
_MOSTLY_FLAT = 0.5
# Areas are looked for within this of the hole [px].
_MARGIN = 48


@dataclass(frozen=True, eq=False)
class FlatRegions:
    """Which flat area is nearest to each pixel of a hole.

    Attributes:
        number: of the area, from 1; 0 is what is not flat, shape [h, w].
        second: the area beyond the nearest border, shape [h, w].
        aside: how far that border is [px], shape [h, w].
        unsure: how far off the borders may be [px], shape [h, w].
        flat: where the areas themselves are, their numbers, shape [h, w]; 0 elsewhere.
        enclosed: known areas that end at the hole with an outline of their own, shape [h, w].
    """

    number: IntImage
    second: IntImage
    aside: FloatImage
    unsure: FloatImage
    flat: IntImage
    enclosed: Mask

    @property
    def apart(self) -> Mask:
        """Where nothing is seen but flat areas, shape [h, w]."""
        return self.enclosed | ((self.number > 0) & ~((self.second == 0) & (self.aside < 1)))

    @property
    def flat_share(self) -> FloatImage:
        """How much of each pixel is flat, shape [h, w]."""
        share = np.clip(np.float32(0.5) + self.aside / 2, 0.5, 1)
        return np.where(self.number > 0, share, 0) + np.where(self.second > 0, 1 - share, 0).astype(np.float32)

    @property
    def count(self) -> int:
        """How many areas there are, what is not flat among them."""
        return int(self.flat.max()) + 1


def flat_regions(picture: FloatImage, hole: Mask, flat: FlatSurroundings, lines: Mask) -> FlatRegions | None:
    """Continue the numbers of flat areas into a hole.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        hole: true where colours are unknown, shape [h, w].
        flat: where what is known is flat.
        lines: where lines have been continued through the hole, shape [h, w]: borders follow them.

    Returns:
        The areas; None where none that is flat touches the hole.
    """
    window = window_around(hole | lines, margin=_MARGIN)
    plain = flat.smooth & (flat.share > _MOSTLY_FLAT)
    near = _regions(picture[window], hole[window], flat.flat[window], plain[window], lines[window])
    if near is None:
        return None
    return FlatRegions(
        _placed(near.number, window, hole.shape, 0),
        _placed(near.second, window, hole.shape, 0),
        _placed(near.aside, window, hole.shape, np.inf),
        _placed(near.unsure, window, hole.shape, 0),
        _placed(near.flat, window, hole.shape, 0),
        _placed(near.enclosed, window, hole.shape, False),
    )


def _placed(part: NDArray[Any], window: tuple[slice, slice], shape: tuple[int, ...], elsewhere: float) -> NDArray[Any]:
    whole = np.full(shape, elsewhere, dtype=part.dtype)
    whole[window] = part
    return whole


def _regions(picture: FloatImage, hole: Mask, flat: Mask, smooth: Mask, lines: Mask) -> FlatRegions | None:
    """The same, within a window."""
    seeds = _seeds(picture, hole, flat, smooth, lines)
    if seeds is None:
        return None
    nearest = nearest_of(seeds >= 0)[1]
    labels = seeds.ravel()[nearest]
    ending = ending_at_edges(picture, hole, flat, labels)
    seeds, labels = np.where(seeds > 0, ending[seeds], seeds), ending[labels]
    rim = _rim(hole)
    if not labels[rim].any():
        return None
    wide = wide_areas(picture, seeds, labels, hole)
    enclosed = _enclosed(picture, rim, labels, nearest)[labels] & ~hole
    voting = next(each for each in (rim & wide & ~enclosed, rim & wide, rim) if each.any())
    labels, unsure = _continued(labels, hole, voting)
    # A strip between two areas that belongs to neither is the soft border of both.
    strip = (labels == 0) & ~hole & ~wide
    if not strip[~hole].all():
        labels = np.where(strip, labels.ravel()[nearest_of(~hole & ~strip)[1]], labels)
    number, second, aside = _borders(labels, int(seeds.max()) + 1)
    return FlatRegions(number, second, aside, unsure, np.maximum(seeds, 0) * flat, enclosed)


def _continued(labels: IntImage, hole: Mask, rim: Mask) -> tuple[IntImage, FloatImage]:
    """Labels from the hole's rim continued into it, and how far off their borders may be [px], shape [h, w]."""
    directions = border_directions(labels, hole)
    continued = elected_areas(labels, hole, rim, directions)
    depth = cv2.distanceTransform(hole.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    return np.where(hole, continued, labels), np.float32(_OFF) * depth * directions.dispersion


def _enclosed(picture: FloatImage, rim: Mask, labels: IntImage, nearest: IntImage) -> Mask:
    """Which areas meet the rim with their own outline, in front of what has been cut out, shape [k].

    A line between rim and area may be a rest of the part's outline as well: that runs along all of the rim.
    """
    row, column = np.nonzero(rim)
    lightness = over_channels(picture) / np.float32(3)
    there = np.divmod(nearest[row, column], rim.shape[1])
    lined = np.zeros(len(row), dtype=bool)
    for part in (0.0, 0.25, 0.5, 0.75):
        on_way = (np.rint(a + part * (b - a)).astype(np.int64) for a, b in zip((row, column), there, strict=True))
        lined |= lightness[tuple(on_way)] < lightness[there] - np.float32(_DARKER)
    own = labels[row, column]
    lined &= own > 0
    count = int(labels.max()) + 1
    share = np.bincount(own, weights=lined, minlength=count) / np.maximum(np.bincount(own, minlength=count), 1)
    return np.asarray((share > _ALL_ALONG) & (lined.mean() < _SELDOM))


def _rim(hole: Mask) -> Mask:
    return ~hole & (cv2.dilate(hole.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0)


def _borders(labels: IntImage, count: int) -> tuple[IntImage, IntImage, FloatImage]:
    """Which area has most of what is around each pixel, which the next most, and how far their border is."""
    most, next_most = np.full((2, *labels.shape), -1, dtype=np.float32)
    first, second = np.zeros((2, *labels.shape), dtype=np.int32)
    for k in range(count):
        own = labels == k
        # The first two are compared with nothing; of the others only what they reach can change.
        if k > 1 and not own.any():
            continue
        part = window_around(own, margin=int(8 * _ROUNDED)) if k > 1 else np.s_[:, :]
        share = cv2.GaussianBlur(own[part].astype(np.float32), (0, 0), _ROUNDED)
        wins, follows = share > most[part], share > next_most[part]
        second[part] = np.where(wins, first[part], np.where(follows, k, second[part]))
        next_most[part] = np.maximum(np.minimum(most[part], share), next_most[part])
        first[part], most[part] = np.where(wins, k, first[part]), np.maximum(most[part], share)
    # Of a straight border the difference rises from zero by this much a pixel.
    slope = np.float32(2 / (_ROUNDED * np.sqrt(2 * np.pi)))
    return first, second, (most - next_most) / slope


def _seeds(picture: FloatImage, hole: Mask, flat: Mask, smooth: Mask, lines: Mask) -> IntImage | None:
    """Numbers of the areas where they are known, 0 what is not flat, and -1 what is not known."""
    if not flat.any():
        return None
    away, nearest = nearest_of(flat)
    count, parts = cv2.connectedComponents(flat.astype(np.uint8), connectivity=4)
    contact = np.bincount(parts.ravel()[nearest][_rim(hole | lines) & (away <= _TOUCH)], minlength=count)
    chosen = np.argsort(-contact, kind="stable")[:_MOST_REGIONS]
    chosen = chosen[contact[chosen] >= _CONTACT]
    if not len(chosen):
        return None
    own = parts[flat]
    sums = [np.bincount(own, weights=plane[flat], minlength=count)[chosen] for plane in cv2.split(picture)]
    colours = (np.stack(sums, axis=1) / np.bincount(own, minlength=count)[chosen, None]).astype(np.float32)
    merged = _merged(colours)
    numbers = np.zeros(count, dtype=np.int32)
    numbers[chosen] = merged + 1
    areas = numbers[parts]
    seen = glimpses(picture, smooth & ~flat & _near(hole | lines), np.where(flat, areas, 0), (colours, merged + 1))
    if seen.any():
        areas = np.where(seen > 0, seen, areas)
        away = cv2.distanceTransform((~(flat | (seen > 0))).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    seeds = np.where(hole | lines | ((away > 0) & (away <= _LINE)), -1, areas)
    if lines.any():
        apart = np.linalg.norm(picture[lines][:, None] - colours, axis=2)
        seeds[lines] = np.where(apart.min(axis=1) < _BESIDE, merged[apart.argmin(axis=1)] + 1, -1)
    return seeds.astype(np.int32)


def _near(where: Mask) -> Mask:
    return cv2.distanceTransform((~where).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5) <= np.float32(_TOUCH)


def _merged(colours: FloatImage) -> IntImage:
    """Numbers of areas, from 0: those of like colours have one number."""
    numbers = np.arange(len(colours))
    for k, colour in enumerate(colours):
        alike = np.flatnonzero(np.linalg.norm(colours[:k] - colour, axis=1) < _ALIKE)
        if len(alike):
            numbers[k] = numbers[alike[0]]
    return np.unique(numbers, return_inverse=True)[1].astype(np.int32)
