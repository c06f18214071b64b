"""Smooth continuation of colours into a hole."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.beside import Beside
from ..pictures import window_around
from .channels import over_channels
from .colour_spreading import spread_sides
from .wide_means import wide_mean

__all__ = ["smooth_fill"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float64]
Mask = NDArray[np.bool_]

# tests/benchmarks/thresholds.py measures half and twice of these: in four holes of 20 to 44 px in the example they
# change the mean error, 12.4 levels of 255, by a twentieth at most. _FEWEST, _MOST, _COARSEST and _SOLVED were left
# out.

# Colours count by distance to this power, more steeply than in a usual mean: what a moving part uncovers first lies
# beside its edge, and looks like what is next to it.
_FILL_POWER = 5.0
# How deep in a hole the harmonic fill has taken over [px].
_DEPTH = 100.0
# Rounds of averaging at each scale, after the start that the coarser one gives.
_SWEEPS = 30
# It takes over only where it differs by less than about this from the colours nearby (Euclidean, in 0 to 1 each).
_AGREEMENT = 0.4
# The plane is fitted to pixels this near to the hole [px], to no fewer and to about no more of them than these numbers.
_BESIDE = 6
_FEWEST = 30
_MOST = 4000
# Rounds in which least squares come close to least absolute deviations.
_REWEIGHTINGS = 12
# A quadratic (a bowl, as in a vignette) takes the plane's place if its mean deviation is less than this share of the
# plane's.
_BETTER = 0.4
# How far a trend may lead beyond the colours that are there, as a share of their range.
_BEYOND = 0.25
# Deviations below this, a level of 255, weigh alike.
_CLOSE = 0.004
# A line of ink is this much darker than what is beside it, and narrower than the disc [px].
_INK = 0.35
_LINE_DISC = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (9, 9))
# Where more than this share of the surroundings within about this distance [px] is ink, it is texture rather than a
# line.
_MOST_INK = 0.1
_AROUND = 20.0
# Far beyond every colour: unknown pixels must win neither a maximum nor a minimum.
_NO_COLOUR = np.float32(9)
# Pictures of which a side is no longer than this are solved for directly, too [px].
_COARSEST = 8
# Up to so many pixels the harmonic fill is solved for directly.
_SOLVED = 16_000
_MEAN_OF_FOUR = np.array([[0, 1, 0], [1, 0, 1], [0, 1, 0]], dtype=np.float32) / 4


def smooth_fill(
    picture: FloatImage, hole: Mask, *, continued: Mask | None = None, apart: Mask | None = None
) -> FloatImage:
    """Fill a hole smoothly: near its edge with the colours there, deep inside harmonically.

    What changes evenly all around, such as a sky, is continued as a plane or a bowl, and the rest by distance, with a
    sharp border between two sides that differ.
    A line of ink that ends at the hole, or runs along it, gives no colour: it would become a stain.
    A harmonic fill alone lets colours from the far side of a narrow hole, often another part of the same figure,
    shine through to where the background will show; colours by distance alone meet in visible ridges.

    Args:
        picture: RGB, shape [h, w, 3].
        hole: where colours are to be found, shape [h, w].
        continued: outside the hole, lines that have been drawn on through it, shape [h, w]; they do give colours.
        apart: what is continued otherwise, shape [h, w]: known colours are not taken from there if there are others,
            and in the hole none are needed.

    Returns:
        RGB, shape [h, w, 3]; unchanged outside the hole.
    """
    trend, curved = _trend(picture, hole)
    # A plane is harmonic by itself, and where the hole meets the picture's border better left out.
    bowl = trend if curved else np.float32(0)
    with Beside(lambda: _harmonic(picture - bowl, hole) + bowl) as solving:
        sources = ~hole & ~_ink(picture, ~hole if continued is None else ~hole & ~continued)
        wanted = hole
        if apart is not None:
            wanted = hole & ~apart
            if (sources & ~apart & _beside(wanted)).sum() >= _FEWEST:
                sources &= ~apart
        near = picture
        if wanted.any():
            near = spread_sides(picture - trend, sources, wanted, power=_FILL_POWER) + trend
    deep, near = solving.result(), np.where(hole[..., None], near, picture)
    depth = cv2.distanceTransform(hole.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    share = np.minimum(depth / np.float32(_DEPTH), 1)[..., None]
    # Where it is far from what is beside, colours of another side shine through.
    differing = np.sqrt(over_channels((deep - near) ** 2))
    share = share * np.exp(-((differing / np.float32(_AGREEMENT)) ** 2))[..., None]
    known = picture[~hole]
    if not len(known):
        return picture
    # A trend must not lead far beyond the colours that are there.
    lowest, highest = known.min(axis=0), known.max(axis=0)
    beyond = np.float32(_BEYOND) * (highest - lowest)
    filled = np.clip(near + share * (deep - near), np.maximum(lowest - beyond, 0), np.minimum(highest + beyond, 1))
    return np.where(hole[..., None], filled, picture)


def _beside(hole: Mask) -> Mask:
    return cv2.dilate(hole.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0


def _ink(picture: FloatImage, known: Mask) -> Mask:
    """Thin known lines, here and there, much darker than what is known on both their sides; with their rims."""
    lightness = over_channels(picture) / np.float32(3)
    widened = cv2.dilate(np.where(known, lightness, -_NO_COLOUR), _LINE_DISC)
    closed = cv2.erode(np.where(widened > -_NO_COLOUR, widened, _NO_COLOUR), _LINE_DISC)
    dark = known & (closed - lightness > _INK)
    if not dark.any():
        return dark
    crowd, some = (wide_mean(each.astype(np.float32), _AROUND) for each in (dark, known))
    dark &= crowd < _MOST_INK * np.maximum(some, np.float32(1e-3))
    return cv2.dilate(dark.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0


def _trend(picture: FloatImage, hole: Mask) -> tuple[FloatImage, bool]:
    """How colours change evenly beside a hole: a plane, or a quadratic where that fits far better.

    Returns:
        The plane or quadratic over the picture, shape [h, w, 3], and whether it is the quadratic. 0 with few pixels.
    """
    height, width = hole.shape
    beside = cv2.dilate(hole.astype(np.uint8), np.ones((2 * _BESIDE + 1,) * 2, np.uint8)) > 0
    row, column = np.nonzero(beside & ~hole)
    if len(row) < _FEWEST:
        return np.zeros_like(picture), False
    row, column = row[:: 1 + len(row) // _MOST], column[:: 1 + len(row) // _MOST]
    x, y = column / width - 0.5, row / height - 0.5
    colours = picture[row, column].astype(np.float64)
    terms = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=1)
    plane, error = _fitted(terms[:, :3], colours)
    bowl, bowl_error = _fitted(terms, colours)
    curved = bowl_error < _BETTER * error
    found = (bowl if curved else plane).astype(np.float32)
    across = np.linspace(-0.5, 0.5, width, endpoint=False, dtype=np.float32)[None, :, None]
    down = np.linspace(-0.5, 0.5, height, endpoint=False, dtype=np.float32)[:, None, None]
    trend = found[0] + found[1] * across + found[2] * down
    if curved:
        trend += (found[3] * across + found[4] * down) * across + found[5] * down * down
    return np.asarray(trend, dtype=np.float32), curved


def _fitted(terms: FloatArray, colours: FloatArray) -> tuple[FloatArray, float]:
    """Coefficients of least absolute deviations, shape [terms, 3], and the mean deviation."""
    weights = np.ones(len(terms))
    for _ in range(_REWEIGHTINGS):
        weighted = terms * weights[:, None]
        found = np.linalg.lstsq(weighted.T @ terms, weighted.T @ colours, rcond=None)[0]
        deviation = np.linalg.norm(colours - terms @ found, axis=1)
        weights = 1 / np.maximum(deviation, _CLOSE)
    return found, float(deviation.mean())


def _harmonic(picture: FloatImage, hole: Mask) -> FloatImage:
    """The hole filled so that every pixel is the mean of its neighbours (Laplace), from coarse to fine."""
    if not hole.any():
        return picture
    if hole.sum() <= _SOLVED or min(hole.shape) <= _COARSEST:
        return _solved(picture, hole)
    size = (hole.shape[1] + 1) // 2, (hole.shape[0] + 1) // 2
    weight = (~hole).astype(np.float32)
    known = cv2.resize(weight, size, interpolation=cv2.INTER_AREA)
    total = cv2.resize(picture * weight[..., None], size, interpolation=cv2.INTER_AREA)
    coarse = _harmonic(total / np.maximum(known, 1e-6)[..., None], known < 0.5)
    guess = cv2.resize(coarse, hole.shape[::-1], interpolation=cv2.INTER_LINEAR)
    filled = np.where(hole[..., None], guess, picture)
    window = window_around(hole, margin=1)
    swept, where = filled[window].copy(), hole[window].astype(np.uint8)
    for _ in range(_SWEEPS):
        mean = cv2.filter2D(swept, -1, _MEAN_OF_FOUR, borderType=cv2.BORDER_REPLICATE)
        swept = cv2.copyTo(mean, where, swept)
    filled[window] = swept
    return filled


def _solved(picture: FloatImage, hole: Mask) -> FloatImage:
    """The harmonic fill by a direct solver."""
    from scipy.sparse import coo_array
    from scipy.sparse.linalg import splu

    if hole.all():
        return np.zeros_like(picture)
    count = int(hole.sum())
    number = np.full(hole.shape, -1)
    number[hole] = np.arange(count)
    row, column = np.nonzero(hole)
    right = np.zeros((count, 3))
    entries = [(np.arange(count), np.arange(count), np.zeros(count))]
    for down, across in ((0, 1), (1, 0), (0, -1), (-1, 0)):
        y, x = row + down, column + across
        within = np.flatnonzero((y >= 0) & (y < hole.shape[0]) & (x >= 0) & (x < hole.shape[1]))
        other = number[y[within], x[within]]
        entries[0][2][within] += 1
        entries.append((within[other >= 0], other[other >= 0], np.full(int((other >= 0).sum()), -1.0)))
        outside = within[other < 0]
        right[outside] += picture[y[outside], x[outside]]
    rows, columns, values = (np.concatenate(each) for each in zip(*entries, strict=True))
    matrix = coo_array((values, (rows, columns)), shape=(count, count)).tocsc()
    filled = picture.copy()
    filled[hole] = splu(matrix).solve(right).astype(np.float32)
    return filled
