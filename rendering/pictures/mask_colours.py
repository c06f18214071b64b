"""What a painted mask shows: the few colours that it is made of, and how much of each pixel is of the part's colour."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from .pixels import as_uint8

__all__ = ["Colour", "colours_of", "flat_levels", "named", "share_of_colour"]

FloatPlane = NDArray[np.float32]

_NAMES = {
    "black": (0, 0, 0),
    "white": (255, 255, 255),
    "grey": (128, 128, 128),
    "red": (230, 20, 20),
    "green": (20, 200, 20),
    "blue": (20, 20, 230),
    "yellow": (240, 230, 20),
    "cyan": (20, 230, 230),
    "magenta": (230, 20, 230),
    "orange": (245, 140, 20),
    "purple": (120, 30, 160),
    "brown": (120, 70, 30),
    "pink": (250, 160, 190),
}
# The masks of tests/rendering/pictures/test_mask_files.py are read the same, with soft edges, JPEG and gradients, at
# half and twice of _BETWEEN, _LEAST_SHARE, _EVEN, _MOSTLY, _LITTLE, _MOST_COLOURS and _APART; and at half of _NEAR, but
# not at twice: a photograph then passes for a mask.
_SAMPLED = 2_000_000  # pixels that are enough to tell the colours of a mask
_NEAR = 60.0  # colours this close are one: JPEG's noise stays within [8-bit RGB]
_BETWEEN = 45.0  # pixels this close to the line between two colours are mixed of them, as soft edges are
_LEAST_SHARE = 0.0005  # of the picture: a colour on less is an accident
_EVEN = 12  # difference of neighbours within an even area, in any channel [8-bit levels]
_MOSTLY = 0.3  # of what is painted must be even for the even areas to tell the colours
_QUANTILE = 0.97  # of a soft edge lies before the colour to which it runs; what lies beyond is noise
_LITTLE = 0.25  # of a colour near it: so little is what JPEG makes of that colour
_MOST_COLOURS = 8  # with more it is no mask, whatever they are
# A level is one of its own, not part of a gradient, if it holds so many times what lies around it.
_APART = 3.0
_WINDOWS = ((1, 5), (6, 18))  # of the level, and of what lies around it [8-bit levels]


@dataclass(frozen=True)
class Colour:
    """A colour of a mask.

    Attributes:
        rgb: the colour, 0 to 255.
        share: how much of the picture has it, 0 to 1.
    """

    rgb: tuple[float, float, float]
    share: float

    @property
    def name(self) -> str:
        """What people call it."""
        red, green, blue = self.rgb
        return min(
            _NAMES, key=lambda name: sum((a - b) ** 2 for a, b in zip(_NAMES[name], (red, green, blue), strict=True))
        )


def colours_of(rgb: NDArray[np.uint8]) -> tuple[list[Colour], float]:
    """The colours that a picture is made of, and the share of its pixels that are none of them nor mixed of two.

    Even areas tell them, where most of what is painted is even; a soft edge runs from one to the other.

    Args:
        rgb: the picture, shape [h, w, 3].
    """
    square = np.ones((3, 3), np.uint8)
    step = max(1, round(np.sqrt(rgb.shape[0] * rgb.shape[1] / _SAMPLED)))
    differences = (cv2.dilate(rgb, square) - cv2.erode(rgb, square))[::step, ::step]
    even, rgb = differences.max(axis=2) <= _EVEN, rgb[::step, ::step]
    colours, other = _clusters(rgb[even]) if even.any() else ([], 1.0)
    painted = (
        np.linalg.norm(rgb.astype(np.float32) - np.array(colours[0].rgb, np.float32), axis=2) >= _NEAR
        if colours
        else ~even
    )
    count = int(np.count_nonzero(painted))
    if np.count_nonzero(painted & even) >= _MOSTLY * max(1, count):
        return colours, other
    return _clusters(rgb.reshape(-1, 3))


def _clusters(pixels: NDArray[np.uint8]) -> tuple[list[Colour], float]:
    codes = (pixels >> 3).astype(np.int32)
    keys = (codes[:, 0] << 10) | (codes[:, 1] << 5) | codes[:, 2]
    counts = np.bincount(keys, minlength=1 << 15)
    bins = np.flatnonzero(counts)
    weights = counts[bins].astype(np.float64) / len(pixels)
    sums = [np.bincount(keys, pixels[:, c].astype(np.float64), minlength=1 << 15)[bins] for c in range(3)]
    means: NDArray[np.float64] = np.stack(sums, axis=1) / counts[bins][:, None]
    found: list[Colour] = []
    left = np.ones(len(bins), bool)
    while left.any() and len(found) < _MOST_COLOURS:
        centre = means[int(np.argmax(np.where(left, weights, -1)))]
        if found:
            centre = _end_of_ramp(centre, np.array(found[0].rgb), means[left], weights[left])
        near = left & (np.linalg.norm(means - centre, axis=1) < _NEAR)
        if weights[near].sum() < _LEAST_SHARE:
            break
        red, green, blue = centre
        colour = Colour((float(red), float(green), float(blue)), float(weights[near].sum()))
        left &= ~near
        if not any(_is_noise_of(colour, each) for each in found[1:]):
            found.append(colour)
            left &= ~_mixed(means, found)
    return found, float(weights[left].sum())


def _is_noise_of(colour: Colour, other: Colour) -> bool:
    """Whether a colour is what JPEG makes of another along its edges: not far from it, and little."""
    away = np.linalg.norm(np.subtract(colour.rgb, other.rgb))
    return bool(away < 2 * _NEAR and colour.share < _LITTLE * other.share)


def _end_of_ramp(
    centre: NDArray[np.float64], start: NDArray[np.float64], means: NDArray[np.float64], weights: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The colour to which a soft edge runs that begins at ``start`` and passes ``centre``."""
    along = (centre - start) / np.linalg.norm(centre - start)
    far = (means - start) @ along
    on = (far > 0) & (np.linalg.norm(means - start - far[:, None] * along, axis=1) < _BETWEEN)
    order = np.argsort(far[on])
    heavy = np.cumsum(weights[on][order])
    last = far[on][order][np.searchsorted(heavy, _QUANTILE * heavy[-1])]
    end = on & (far > last - _BETWEEN / 2)
    return np.asarray(np.average(means[end], axis=0, weights=weights[end] * np.square(far[end])))


def _mixed(means: NDArray[np.float64], found: Sequence[Colour]) -> NDArray[np.bool_]:
    """Which colours lie on a line between the last of the found ones and an earlier one."""
    mixed = np.zeros(len(means), bool)
    last = np.array(found[-1].rgb)
    for other in found[:-1]:
        along = np.array(other.rgb) - last
        place = np.clip((means - last) @ along / max(1.0, along @ along), 0, 1)
        mixed |= np.linalg.norm(last + place[:, None] * along - means, axis=1) < _BETWEEN
    return mixed


def share_of_colour(rgb: NDArray[np.uint8], part: Colour, beside: Colour) -> FloatPlane:
    """How much of each pixel is of the part's colour where the rest is of the one beside it, 0 to 1, shape [h, w]."""
    low, along = np.array(beside.rgb), np.array(part.rgb) - np.array(beside.rgb)
    weights = along / (along @ along)
    plane = cv2.transform(rgb.astype(np.float32), weights.astype(np.float32)[None]) - np.float32(low @ weights)
    return np.clip(np.asarray(plane, dtype=np.float32), 0, 1)


def flat_levels(plane: FloatPlane) -> list[tuple[float, float]]:
    """The levels, 0 to 1, that areas of a grey plane have, each with its share of the plane, from dark to bright.

    Soft edges and gradients have none: every level of theirs has neighbours that hold as much.
    """
    square = np.ones((3, 3), np.uint8)
    levels = as_uint8(plane)
    flat = ((cv2.dilate(levels, square) - cv2.erode(levels, square)) <= _WINDOWS[1][0]).astype(np.uint8)
    counts = cv2.calcHist([levels], [0], flat, [256], [0, 256]).ravel().astype(np.float64)
    # At least four pixels, a thousandth of the plane and a fiftieth of what is brighter than black.
    least = max(4.0, 0.001 * levels.size, 0.02 * counts[9:].sum())
    found, all_counts = [], counts.copy()
    for level in np.argsort(-counts):
        if counts[level] <= 0:  # it was counted with a level beside it, which noise has spread
            continue
        for window, around in _WINDOWS:
            first = max(0, level - window)
            own = counts[first : level + window + 1]
            near = own.sum()
            beside = all_counts[max(0, level - around) : level + around + 1].sum() - near
            if near >= max(least, _APART * beside):
                middle = int(np.searchsorted(np.cumsum(own), near / 2))
                found.append((float(first + middle) / 255, float(near / levels.size)))
                counts[max(0, level - _WINDOWS[1][0]) : level + _WINDOWS[1][0] + 1] = 0
                break
    return sorted(found)


def named(colours: Sequence[Colour], other: float) -> str:
    """The colours with their shares, for a person."""
    listed = [f"{each.name} {_percent(each.share)}" for each in colours[:6]]
    if len(colours) > 6 or other > 0.005:
        listed.append("others")
    counted = "one colour" if len(listed) == 1 else f"{len(colours)} colours"
    return f"{counted}: {', '.join(listed)}"


def _percent(share: float) -> str:
    return f"{100 * share:.0f} %" if share >= 0.01 else "under 1 %"
