"""Colours of known pixels continued to unknown ones by distance: as a mean, or with a border between two sides."""

from __future__ import annotations

import warnings

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import window_around

__all__ = ["spread_colours", "spread_sides"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float64]
Mask = NDArray[np.bool_]

# Larger windows are filled at half their size, which is a quarter of the work: colours change slowly in a hole as large
# as that. Against known pictures behind drawn holes it errs as little, at 600 000 as well [px^2].
_LARGEST_WINDOW = 150_000
_HALF = 0.5

# Half and twice of the following, measured as in smooth_fill, change the mean error by a fortieth at most.

# Colours along the edge are averaged over this width before they are grouped [px]: a texture is one thing.
_ALONG = 12.0
# Colours along the edge are told apart in no more groups than this.
_GROUPS = 8
# Groups that differ less than about this are on one side.
_ALIKE = 0.2
# Exponent by which the group with the larger weight wins over the others: 0 blends, large ones draw a sharp border. It
# falls off over this distance from the edge [px]: deep in a hole the border's place is a guess, and a blend errs less.
_SHARPNESS = 3.0
_REACH = 50.0


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
    return _spread(picture, known, wanted, power, sides=False)


def spread_sides(picture: FloatImage, known: Mask, wanted: Mask, *, power: float = 4.0) -> FloatImage:
    """The same, but where different colours meet from two sides, one gives way to the other along a sharp border.

    Between a dress and the sky behind it, their mean is a fog that belongs to neither.
    """
    return _spread(picture, known, wanted, power, sides=True)


def _spread(picture: FloatImage, known: Mask, wanted: Mask, power: float, *, sides: bool) -> FloatImage:
    if wanted.size > _LARGEST_WINDOW:
        return _spread_at_half_size(picture, known, wanted, power, sides=sides)
    edge = known & (cv2.dilate(wanted.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0)
    if not edge.any():
        edge = known
    if not edge.any():
        return picture
    window = window_around(edge | wanted, margin=0)
    filled = picture.copy()
    filled[wanted] = _from_edge(picture[window], edge[window], wanted[window], power, sides=sides)
    return filled


def _from_edge(picture: FloatImage, edge: Mask, wanted: Mask, power: float, *, sides: bool) -> FloatArray:
    """The wanted colours from those along an edge, shape [n, 3]."""
    groups = _groups(picture, edge) if sides else np.zeros(int(edge.sum()), dtype=np.int32)
    weights, colours = _by_distance(picture, edge, wanted, groups, power)
    shares = weights
    if len(weights) > 1:
        depth = cv2.distanceTransform((~edge).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)[wanted]
        means = np.stack([picture[edge][groups == k].mean(axis=0) for k in range(len(weights))])
        shares = _competing(weights, means, depth)
    return np.asarray(np.einsum("kn,kcn->nc", shares / (shares.sum(axis=0) * weights), colours))


def _groups(picture: FloatImage, edge: Mask) -> NDArray[np.int32]:
    """To which group of like colours each pixel of an edge belongs, in the order of ``picture[edge]``, shape [n]."""
    from scipy.cluster.vq import kmeans2

    weight = edge.astype(np.float32)
    along = [
        cv2.GaussianBlur(plane, (0, 0), _ALONG, borderType=cv2.BORDER_CONSTANT)[edge]
        for plane in (weight, *(picture[..., k] * weight for k in range(3)))
    ]
    colours = np.stack(along[1:], axis=1).astype(np.float64) / np.maximum(along[0], 1e-9)[:, None]
    count = min(_GROUPS, len(np.unique(np.round(colours, 3), axis=0)))
    if count < 2:
        return np.zeros(len(colours), dtype=np.int32)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="One of the clusters is empty")
        labels = kmeans2(colours, _far_apart(colours, count), minit="matrix")[1]
    return np.unique(labels, return_inverse=True)[1].astype(np.int32)


def _far_apart(colours: FloatArray, count: int) -> FloatArray:
    """The first colour, then always the one farthest from those chosen, shape [count, 3]."""
    chosen = [colours[0]]
    distance = np.linalg.norm(colours - chosen[0], axis=1)
    while len(chosen) < count:
        chosen.append(colours[np.argmax(distance)])
        distance = np.minimum(distance, np.linalg.norm(colours - chosen[-1], axis=1))
    return np.array(chosen)


def _by_distance(
    picture: FloatImage, known: Mask, wanted: Mask, groups: NDArray[np.int32], power: float
) -> tuple[FloatArray, FloatArray]:
    """Sum of distance^-power to each group's pixels, shape [k, n], and of their values so weighted, [k, c, n].

    Both are convolutions. Rows that are empty, or that nobody asks for, are left out of the transforms.
    """
    from scipy import fft

    # Double precision: the weights span more than the range of single precision.
    height, width = known.shape
    size = [fft.next_fast_len(2 * length, real=True) for length in known.shape]
    y, x = (np.minimum(np.arange(length), length - np.arange(length)).astype(np.float64) for length in size)
    # That of an even function is real.
    kernel = np.ascontiguousarray(fft.rfft2((y[:, None] ** 2 + x**2 + 0.5) ** (-power / 2)).real)
    row, column = np.nonzero(known)

    def convolved(values: FloatArray, at: NDArray[np.intp]) -> FloatArray:
        first, last = int(row[at].min()), int(row[at].max()) + 1
        plane = np.zeros((last - first, width))
        plane[row[at] - first, column[at]] = values
        turned = np.zeros(kernel.shape, dtype=np.complex128)
        turned[first:last] = fft.rfft(plane, size[1], workers=-1)
        turned = fft.fft(turned, axis=0, overwrite_x=True, workers=-1)
        turned *= kernel
        back = fft.ifft(turned, axis=0, overwrite_x=True, workers=-1)[:height]
        return np.asarray(fft.irfft(back, size[1], workers=-1)[:, :width][wanted])

    colours = picture[known].astype(np.float64)
    count = int(groups.max()) + 1
    channels, pixels = picture.shape[2], int(wanted.sum())
    weights, sums = np.empty((count, pixels)), np.empty((count, channels, pixels))
    for k in range(count):
        own = np.flatnonzero(groups == k)
        weights[k] = np.maximum(convolved(np.ones(len(own)), own), 1e-13)
        for channel in range(channels):
            values = colours[own, channel]
            sums[k, channel] = convolved(values, own) if values.any() else 0
    return weights, sums


def _competing(weights: FloatArray, means: FloatImage, depth: FloatImage) -> FloatArray:
    """The weights of groups sharpened, so that the one with the most support wins, shape [k, n].

    Args:
        weights: of each group at each pixel, shape [k, n].
        means: mean colour of each group, shape [k, 3]; groups of like colours support each other.
        depth: distance from the edge [px], shape [n].
    """
    apart = np.linalg.norm(means[:, None] - means[None], axis=-1)
    shares = weights / weights.sum(axis=0)
    support = np.tensordot(np.exp(-((apart / _ALIKE) ** 2)), shares, axes=1)
    sharpness = _SHARPNESS * np.exp(-((depth / _REACH) ** 2))
    # Powers of small numbers vanish: only the proportion counts.
    return np.asarray(shares * (support / support.max(axis=0)) ** sharpness)


def _spread_at_half_size(picture: FloatImage, known: Mask, wanted: Mask, power: float, *, sides: bool) -> FloatImage:
    size = (wanted.shape[1] + 1) // 2, (wanted.shape[0] + 1) // 2
    weight = cv2.resize(known.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    total = cv2.resize(picture * known[..., None], size, interpolation=cv2.INTER_AREA)
    some = cv2.resize(wanted.astype(np.float32), size, interpolation=cv2.INTER_AREA) > 0
    small = total / np.maximum(weight, 1e-6)[..., None]
    # What is half known counts: else all colours would be taken from a pixel or two behind the edge.
    known = weight >= _HALF
    small = _spread(small, known, some & ~known, power, sides=sides)
    large = cv2.resize(small, wanted.shape[::-1], interpolation=cv2.INTER_LINEAR)
    return np.where(wanted[..., None], large, picture)
