"""Where a part ends in the picture, near the edge of a mask that is only about right.

Pixels near the edge are told apart by colours: those of the mask's core, those well outside of it, and neither. A
random walk (Grady, "Random Walks for Image Segmentation", 2006) then divides them along the picture's own edges.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.beside import side_by_side
from ..pictures import nearest_pixels
from .drawn_lines import WIDEST_LINE, disc
from .like_regions import like_regions
from .mask_edges import SQUARE
from .random_walk import chance_of_core

__all__ = ["explained", "found_shape"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

_HALF = 0.5
# A thin part's middle is as far from its edge as this share of the greatest distance near by.
_MIDDLE = 0.7
_NEARBY = np.ones((23, 23), np.uint8)
# Colours are compared with so many of either side, half of them from the near and half from the wider surroundings
# [px]; the best few count. Colours this much apart are alike.
_SAMPLES = 36
_NEAR, _FAR = 9, 30
_BEST = 3
_ALIKE = 0.08
# And with so many of all of a side; colours that differ by less are then the same.
_ANYWHERE, _ROUGHLY = 256, np.float32(0.04)
_PLACES = 32.0 ** np.arange(4)
# So many pixels are compared at once: what is read then stays in the processor's cache.
_AT_ONCE = 8192
# A colour of neither side is more often the part's, whose outline is drawn, than the background's.
_OUTLINE, _STRANGE = 0.07, 0.02
# From this on, colours deny that a pixel is the other side's.
_DENIED = 2 / 3
# Colours of neighbours that differ by less go on in one another.
_STEP = 0.1
# So far beyond the band seeds are asked by those farther off [px].
_BEHIND = 20
# Distance from the mask's edge, as a share of the reach, at which the mask itself is e : 1 sure; and its weight.
_UNSURE, _WEIGHT = 0.35, 0.5
_SPECK = 12


def found_shape(image: FloatImage, mask: FloatImage, reach: FloatImage) -> tuple[Mask, FloatImage]:
    """Divide the pixels near the edge of a mask between the part and what is around it.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        mask: soft mask in 0 to 1, shape [h, w].
        reach: how far from the mask's edge that of the part may be [px], shape [h, w].

    Returns:
        The part, shape [h, w]; and how likely each colour is the part's, one half where nothing is known, shape [h, w].
    """
    inside = mask > _HALF
    depth, away = _depth(inside), _depth(~inside)
    core, outside = _seeds(image, (depth > reach, away > reach), (_middle(depth), _middle(away)))
    band = ~core & ~outside
    likely = np.full(mask.shape, _HALF, dtype=np.float32)
    if not (core.any() and outside.any() and band.any()):
        return inside, likely
    telling = _telling(image, core, outside, (depth - reach, away - reach))
    likely[band] = _likely(image, band, *telling, elsewhere=True)
    further = _going_on(image, (core | band) & (likely > _DENIED) | core, outside & ~telling[1])
    if further.any():
        likely[further] = _likely(image, further, *telling)
        band |= further
    way = np.clip((depth - away)[band] / (_UNSURE * reach[band]), -20, 20)
    odds = likely[band] / (1 - likely[band]) * np.exp(_WEIGHT * way)
    shape = inside.copy()
    shape[band] = chance_of_core(image, mask, band, core, odds / (1 + odds)) > _HALF
    return _tidied(shape, core), likely


def _seeds(image: FloatImage, far: tuple[Mask, Mask], middles: tuple[Mask, Mask]) -> tuple[Mask, Mask]:
    """What is the part's for sure, and what is not: all far from the edge of the mask, and the middle of what is thin.

    Where a mask misses the part by as much as a piece is wide, the middle of that piece lies on the other side, or on
    the outline: a middle whose colours deny it is not sure.
    """
    core, outside = far[0] | middles[0], far[1] | middles[1]
    if far[0].any():
        asked = middles[0] & ~far[0]
        core[asked] = _likely(image, asked, far[0], outside) > 1 - _DENIED
    if far[1].any():
        asked = middles[1] & ~far[1]
        outside[asked] = _likely(image, asked, core, far[1]) < _DENIED
    return core, outside


def _telling(image: FloatImage, core: Mask, outside: Mask, beyond: tuple[FloatImage, FloatImage]) -> tuple[Mask, Mask]:
    """What of either side its colours may be taken from.

    A mask that misses by more than the reach has some of the part outside, and something of what is around inside. Its
    colours would speak for the wrong side; so what lies next to the band is asked by what lies farther off.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        core: what is the part's for sure, shape [h, w].
        outside: what is not, shape [h, w].
        beyond: how far inside and outside of the band pixels lie [px], shape [h, w] each.
    """
    near = core & (beyond[0] <= _BEHIND), outside & (beyond[1] <= _BEHIND)
    far = core & ~near[0], outside & ~near[1]
    if not (far[0].any() and far[1].any()):
        return core, outside
    likely, asked = np.full(core.shape, _HALF, dtype=np.float32), near[0] | near[1]
    likely[asked] = _likely(image, asked, *far)
    telling = core & ~(near[0] & (likely <= 1 - _DENIED)), outside & ~(near[1] & (likely >= _DENIED))
    return telling if telling[0].any() and telling[1].any() else (core, outside)


def _going_on(image: FloatImage, part: Mask, denied: Mask) -> Mask:
    """What the part's colours go on in beyond the band without an edge between, shape [h, w].

    Where a mask cuts off the end of a part by more than the reach, as a lasso does with tips, the picture shows no edge
    at the band's end, and what lies beyond is not outside for sure.
    """
    free = part | denied
    labels = like_regions(image, free, step=_STEP)
    kept = np.zeros(int(labels.max()) + 1, dtype=bool)
    kept[labels[part]] = True
    kept[0] = False
    return denied & kept[labels]


def _likely(image: FloatImage, asked: Mask, core: Mask, outside: Mask, *, elsewhere: bool = False) -> FloatImage:
    """How likely the colours of some pixels are the part's, shape [n].

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        asked: the pixels, shape [h, w].
        core: what is the part's for sure, shape [h, w].
        outside: what is not, shape [h, w].
        elsewhere: a colour that neither side has near by is the rest's if that has more of it farther off, see
            ``_wide_and_strange``; it need not be the part's if the part has more.
    """
    if not (asked.any() and core.any() and outside.any()):
        return np.full(int(asked.sum()), _HALF, dtype=np.float32)
    part, rest = explained(image, asked, core), explained(image, asked, outside)
    if elsewhere and (strange := _wide_and_strange(asked, part + rest)).any():
        colours = image[asked][strange]
        of_part, of_rest = (_share_alike(colours, image, side) for side in (core, outside))
        more = np.maximum(of_rest - of_part, 0) / np.maximum(of_rest + of_part, np.float32(1e-6))
        rest[strange] = np.where(of_rest > _BEST / _ANYWHERE, more, 0)
    return (part + _OUTLINE) / (part + rest + _OUTLINE + _STRANGE)


def _wide_and_strange(asked: Mask, known: FloatImage) -> Mask:
    """Which pixels are of areas wider than a drawn line in colours that neither side has near by, shape [n].

    An outline is a line. What is wider may be what is behind the part, seen through a gap that the mask has closed:
    then the nearest pixels outside are those of something else beyond the gap.
    """
    strange = np.zeros(asked.shape, dtype=np.uint8)
    strange[asked] = known < _STRANGE
    return cv2.morphologyEx(strange, cv2.MORPH_OPEN, disc(WIDEST_LINE // 2 + 1))[asked] > 0


def _share_alike(colours: FloatImage, image: FloatImage, side: Mask) -> FloatImage:
    """The share of all of one side's colours that are like each of some colours, shape [n]."""
    known = np.flatnonzero(side)
    samples = image.reshape(-1, image.shape[2])[known[np.random.default_rng(0).integers(len(known), size=_ANYWHERE)]]
    number = np.rint(colours / _ROUGHLY) @ _PLACES[: image.shape[2]]
    _, first, same = np.unique(number, return_index=True, return_inverse=True)
    asked = colours[first]
    away = (asked * asked).sum(axis=1)[:, None] + (samples * samples).sum(axis=1) - 2 * asked @ samples.T
    return np.asarray(np.exp(away / np.float32(-2 * _ALIKE**2)).mean(axis=1), dtype=np.float32)[same]


def _depth(shape: Mask) -> FloatImage:
    """Distance of a shape's pixels from its edge [px]."""
    distance = cv2.distanceTransform(shape.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    return np.asarray(np.where(shape, distance - np.float32(_HALF), 0), dtype=np.float32)


def _middle(depth: FloatImage) -> Mask:
    """The middle of what is thin."""
    ridge = (cv2.dilate(depth, SQUARE) <= depth + 1e-3) & (depth >= 1.5)
    return ridge & (depth > _MIDDLE * cv2.dilate(depth, _NEARBY))


def explained(image: FloatImage, band: Mask, side: Mask) -> FloatImage:
    """How well the colours of one side explain each pixel of the band, 0 to 1, shape [n]."""
    random = np.random.default_rng(0)
    spans = np.repeat([_NEAR, _FAR], _SAMPLES // 2)[:, None]
    steps = np.rint(random.uniform(-1, 1, (_SAMPLES, 2)) * spans).astype(np.int64)
    colours, nearest = [plane.ravel() for plane in cv2.split(image)], nearest_pixels(side)[1]
    numbers = np.flatnonzero(band)
    row, column = np.divmod(nearest.ravel().take(numbers), np.int64(band.shape[1]))
    places = (row + _FAR) * (band.shape[1] + 2 * _FAR) + column + _FAR
    # A sample beyond the border is taken at the border.
    around = cv2.copyMakeBorder(nearest, *[_FAR] * 4, cv2.BORDER_REPLICATE)
    away, beside = steps @ (around.shape[1], 1), around.ravel().astype(np.int64)

    def share(some: slice) -> FloatImage:
        own = [plane.take(numbers[some]) for plane in colours]
        best = _best_of(own, colours, beside, places[some], away)
        return np.asarray(np.exp(-best / (2 * _ALIKE**2)).mean(axis=0), dtype=np.float32)

    blocks = [slice(start, start + _AT_ONCE) for start in range(0, len(numbers), _AT_ONCE)]
    return np.concatenate([np.zeros(0, np.float32), *side_by_side(share, blocks)])


def _best_of(
    own: Sequence[FloatImage],
    colours: Sequence[FloatImage],
    beside: NDArray[np.int64],
    places: NDArray[np.int64],
    away: NDArray[np.int64],
) -> FloatImage:
    """The smallest squared distances of colours to those of samples, smallest first, shape [_BEST, n].

    Args:
        own: the colours that are compared, one array of shape [n] for each channel.
        colours: of the picture, likewise, shape [h w] each.
        beside: which of them is the sample at each place, shape [p].
        places: around which samples are taken, shape [n].
        away: how far from there each sample is, shape [s].
    """
    best = np.full((_BEST, len(places)), np.inf, dtype=np.float32)
    place, sample = np.empty((2, len(places)), dtype=np.int64)
    distance, more = np.empty((2, len(places)), dtype=np.float32)
    for step in away:
        np.add(places, step, out=place)
        beside.take(place, out=sample, mode="clip")
        distance[:] = 0
        for compared, plane in zip(own, colours, strict=True):
            plane.take(sample, out=more, mode="clip")
            more -= compared
            more *= more
            distance += more
        for kept in best:
            np.maximum(kept, distance, out=more)
            np.minimum(kept, distance, out=kept)
            distance, more = more, distance
    return best


def _tidied(shape: Mask, core: Mask) -> Mask:
    """The pieces that hang together with the core, without pinholes."""
    _, labels = cv2.connectedComponents(shape.astype(np.uint8), connectivity=8)
    kept = np.zeros(int(labels.max()) + 1, dtype=bool)
    kept[np.unique(labels[core])] = True
    kept[0] = False
    tidied = kept[labels]
    _, labels, statistics, _ = cv2.connectedComponentsWithStats((~tidied).astype(np.uint8), connectivity=4)
    small = statistics[:, cv2.CC_STAT_AREA] < _SPECK
    small[0] = False
    return tidied | small[labels]
