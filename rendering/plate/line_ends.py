"""Where drawn lines and edges of colour run into a hole."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import StructureTensor, gradients
from .channels import over_channels
from .line_end import HALF_WIDTH, LEAST_REACH, LineEnd

__all__ = ["DISTANCE", "line_ends"]

FloatImage = NDArray[np.float32]
FloatArray = NDArray[np.float64]
Mask = NDArray[np.bool_]

DISTANCE = 5
"""Lines are looked for this far outside the hole [px], where the tensor's window sees enough of them."""

# A profile reaches this far, so that colours can be told to rest beside the widest line [px].
_REACH = HALF_WIDTH + 5

# Half and twice each of these, measured as in line_continuation: _FAINTEST changes how much is drawn by 40 % at most,
# the others from nothing to nearly three times as much.

# Width of the tensor's window [px].
_SIGMA = 2.5
# Mean gradient over the window (colours in 0 to 1, per pixel) of the faintest line, and how much more it changes
# across than along.
_FAINTEST = 0.015
_COHERENCE = 0.7
# The cosine of the angle between a line and the way into the hole.
_STEEPEST = 0.4
# Of lines closer than this along the rim [px], the strongest counts.
_APART = 6
# Steps of one pixel along which a line is followed, and the fewest that it must run on.
_STEPS = 24
_FEWEST = 12
# The strongest so many are followed: pairs are compared each with each.
_MOST_ENDS = 160
# The middle of a line is looked for within about this [px].
_LINE = 4.0
# Rounds in which the window moves to the middle that it finds.
_CENTRINGS = 8


@dataclass(frozen=True, eq=False)
class _Field:
    """Directions along lines, float64, shape [h, w, 2]; mean gradient and coherence, shape [h, w]."""

    along: FloatArray
    strength: FloatArray
    coherence: FloatArray


def line_ends(picture: FloatImage, hole: Mask) -> list[LineEnd]:
    """Every line and edge that runs into a hole.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        hole: true where colours are unknown, shape [h, w].
    """
    outside = cv2.distanceTransform((~hole).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    # The pixels right at the hole may still be mixed with what is cut out.
    known = (outside > 1.5).astype(np.float32)
    field = _structure(picture, known)
    near = (outside <= DISTANCE).astype(np.uint8)
    # Positive inside the hole, so that its gradient is the way in.
    depth = cv2.GaussianBlur(
        cv2.distanceTransform(hole.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5) - outside, (0, 0), 3.0
    )
    inward = np.stack([cv2.Sobel(depth, cv2.CV_64F, 1, 0), cv2.Sobel(depth, cv2.CV_64F, 0, 1)], axis=-1)
    ends = []
    for contour in cv2.findContours(near, cv2.RETR_LIST, cv2.CHAIN_APPROX_NONE)[0]:
        ends += _ends_along(contour[:, 0], field, inward)
    strongest = sorted(ends, key=lambda each: -each[0])[:_MOST_ENDS]
    followed = [_followed(picture, known, field, *end[1:]) for end in strongest]
    return [end for end in followed if end is not None]


def _structure(picture: FloatImage, known: FloatImage) -> _Field:
    """The structure tensor's eigenvectors, from known pixels alone."""
    inner = cv2.erode(known, np.ones((3, 3), np.uint8))
    dx, dy = (change * inner[..., None] for change in gradients(picture))
    weight = np.maximum(cv2.GaussianBlur(inner, (0, 0), _SIGMA), 1e-3)
    xx, xy, yy = (
        (cv2.GaussianBlur(over_channels(product), (0, 0), _SIGMA) / weight).astype(np.float64)
        for product in (dx * dx, dx * dy, dy * dy)
    )
    tensor = StructureTensor(xx, xy, yy)
    spread = tensor.spread
    return _Field(tensor.along, np.sqrt((xx + yy + spread) / 2), spread / np.maximum(xx + yy, 1e-9))


def _ends_along(
    contour: NDArray[np.int32], field: _Field, inward: FloatArray
) -> list[tuple[float, int, int, FloatArray]]:
    """Strength, column, row and direction of the lines that cross a contour, shape [n, 2]."""
    column, row = contour.T
    height, width = field.strength.shape
    strength, along, way = field.strength[row, column], field.along[row, column], inward[row, column]
    cosine = np.einsum("ij,ij->i", along, way) / np.maximum(np.linalg.norm(way, axis=1), 1e-9)
    best = strength * np.abs(cosine)
    reach = np.arange(-_APART, _APART + 1)
    highest = best[(np.arange(len(best))[:, None] + reach) % len(best)].max(axis=1)
    within = (column > 2) & (row > 2) & (column < width - 3) & (row < height - 3)
    good = within & (best >= highest) & (strength > _FAINTEST) & (field.coherence[row, column] > _COHERENCE)
    good &= np.abs(cosine) > _STEEPEST
    return [
        (float(strength[k]), int(column[k]), int(row[k]), along[k] * np.sign(cosine[k])) for k in np.flatnonzero(good)
    ]


def _followed(
    picture: FloatImage, known: FloatImage, field: _Field, column: int, row: int, direction: FloatArray
) -> LineEnd | None:
    """The end of the line through a pixel, if it runs on outwards."""
    height, width = known.shape
    position, heading = np.array([column, row], dtype=np.float64), -direction
    path, headings = [position], [heading]
    for _ in range(_STEPS):
        x, y = np.rint(position).astype(int)
        if not (0 <= x < width and 0 <= y < height) or field.coherence[y, x] < _COHERENCE / 2 or not known[y, x]:
            break
        along = field.along[y, x]
        along = along * (1.0 if along @ heading >= 0 else -1.0)
        if along @ heading < 0.8:  # a line turns by less than 37 degrees within a pixel
            break
        heading = along
        position = position + heading
        path.append(position)
        headings.append(heading)
    if len(path) <= _FEWEST:
        return None
    points, ways = np.array(path), np.array(headings)
    out = points[_FEWEST] - points[0]
    into = -out / np.linalg.norm(out)
    if len(points) > 2 * _FEWEST:
        # A curved line has turned by half as much again where it reaches the hole.
        earlier = points[_FEWEST] - points[2 * _FEWEST]
        into = into + 0.5 * (into - earlier / np.linalg.norm(earlier))
        into /= np.linalg.norm(into)
    profile = _profile(picture, known, points[:_FEWEST], -ways[:_FEWEST])
    if profile is None:
        return None
    end = LineEnd(points[0] + 0.5, into, profile)
    return end.moved(_centre(profile))


def _centre(profile: FloatArray) -> float:
    """Where in a profile the colours change, in the mean [px]; the middle counts more than the ends."""
    at = np.arange(len(profile) - 1) - len(profile) // 2 + 0.5
    change, centre = (np.diff(profile, axis=0) ** 2).sum(axis=1), 0.0
    for _ in range(_CENTRINGS):
        weight = change * np.exp(-(((at - centre) / _LINE) ** 2) / 2)
        centre = float((weight * at).sum() / max(float(weight.sum()), 1e-12))
    return float(np.clip(centre, -_LINE, _LINE))


def _profile(picture: FloatImage, known: FloatImage, path: FloatArray, heading: FloatArray) -> FloatArray | None:
    """Mean colours across a line along its path, shape [2 _REACH + 1, 3]."""
    offsets = np.arange(-_REACH, _REACH + 1)
    normal = np.stack([-heading[:, 1], heading[:, 0]], axis=1)
    at = (path[:, None] + offsets[:, None] * normal[:, None]).astype(np.float32)
    colours = cv2.remap(picture, at, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    weight = cv2.remap(known, at, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=0)
    weight = np.where(weight > 0.99, 1.0, 0.0)
    total = weight.sum(axis=0)
    seen = np.flatnonzero(total)
    if not total[_REACH - LEAST_REACH : _REACH + LEAST_REACH + 1].all():
        return None
    mean = (colours * weight[..., None]).sum(axis=0)[seen] / total[seen, None]
    # What the hole hides of the line's surroundings looks like what is seen of them next to it.
    return np.stack([np.interp(np.arange(len(total)), seen, mean[:, k]) for k in range(3)], axis=1)
