"""Soft alpha: which share of each pixel belongs to a moving part.

Masks from people and from segmentation are often hard-edged, or end a pixel or two inside the part's drawn outline.
An outline pixel that stays behind is seen as a ghost, a background pixel that goes along as a halo. So the
mask is first grown over the outline that runs along it, and hard edges become shares, measured by where the pixel's
colour lies between the background's colour and the part's.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .line_share import share_of_line

__all__ = ["fitting_plate", "mixed_rim", "soft_alpha", "window_around", "with_outline"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

_FAINT = 0.02
# The outermost pixels of a mask are above this in the mean along a hard edge, and near one half along a soft one.
_HARD = 0.75
_SQUARE = np.ones((3, 3), np.uint8)
# An outline beside this share of a mask's whole edge is none by chance.
_OUTLINED = 0.45
_WIDE = np.ones((7, 7), np.uint8)
_CROSS = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], np.uint8)
# An outline is told from the background's own texture by its mean along the edge, over about this length [px].
_SIGMA = 5.0
_TOLERANCE = 0.055
# A smaller share of a pixel outside the mask is taken for the background's own texture.
_LEAST_SHARE = 0.06
_SOLID = 0.95
_LEAST_CONTRAST = 0.1
# Up to the first difference a soft edge is trusted, from the second on the picture is.
_TRUST = 0.1
_DISBELIEF = 0.4
_SPECK = 20
# A picture's colours are rounded to 255 levels: what stays within a little less than half of one rounds to the same.
_ROUNDING = 0.49 / 255
_LUMINANCE = np.array([0.299, 0.587, 0.114], dtype=np.float32)


def with_outline(image: FloatImage, mask: FloatImage, *, reach: int = 5) -> Mask:
    """Where a part is, its drawn outline included.

    An outline is what runs along a hard edge of the mask, hangs together with it and is darker than what lies
    beyond ``reach``; a mask whose edge is soft has been drawn or cut with care, and ends where the part does, unless
    such an outline runs along about half of it: then the mask has been made smaller or blurred afterwards.
    The pixels are compared one pixel of distance after the other, in the mean along the edge, so that the
    background's own texture cancels; the difference must exceed how much those beyond differ among themselves.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        mask: soft mask in 0 to 1, shape [h, w].
        reach: how far an outline may lie outside the mask [px].

    Returns:
        True in the part, shape [h, w]; includes every pixel of the mask above 0.02.
    """
    support = mask > _FAINT
    if not support.any() or support.all():
        return support
    window = window_around(support, margin=4 * reach)
    inside, lightness = support[window], image[window] @ _LUMINANCE
    distance = cv2.distanceTransform((~inside).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    beyond = (distance > reach) & (distance <= 2 * reach)
    reference, known = _mean_near(lightness, beyond)
    spread = np.sqrt(np.maximum(_mean_near(lightness * lightness, beyond)[0] - reference * reference, 0))
    outline = np.zeros_like(inside)
    for step in range(reach):
        ring = (distance > step) & (distance <= step + 1)
        outline |= ring & known & (_mean_near(lightness, ring)[0] < reference - spread - _TOLERANCE)
    grown = _joined(inside, outline, reach)
    rim = _grown(inside, _SQUARE) & ~inside
    if (grown & rim).sum() < _OUTLINED * rim.sum():
        grown = _joined(inside, outline & _hard(mask[window], inside), reach)
    support[window] = grown
    return support


def mixed_rim(mask: FloatImage, support: Mask) -> Mask:
    """Pixels just outside a part that may show something of it, shape [h, w].

    A hard edge cuts through pixels that show both sides; where an outline was found, it has been included already.

    Args:
        mask: soft mask in 0 to 1, shape [h, w].
        support: where the part is, from ``with_outline``; shape [h, w].
    """
    inside = mask > _FAINT
    return _grown(inside, _SQUARE) & ~support & _hard(mask, inside)


def soft_alpha(image: FloatImage, plate: FloatImage, mask: FloatImage, support: Mask) -> FloatImage:
    """Share of each pixel that belongs to a part.

    At hard edges of the mask the share is measured from the pixel's colour I, the background's B and the part's F from
    two pixels further inside: |I - B| / |F - B| within the mask, where any other colour than the background's is the
    part's, and (I - B)(F - B) / |F - B|^2 beside it. A soft edge is taken as it is, unless the share is much smaller or
    larger. On an outline found outside the mask F is the line's own colour, where it is fullest.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        plate: what is behind the part, at least up to two pixels around ``support``; shape [h, w, 3].
        mask: soft mask in 0 to 1, shape [h, w].
        support: where the part is, from ``with_outline``; shape [h, w].

    Returns:
        Alpha in 0 to 1, shape [h, w].
    """
    grown = support & (mask <= _FAINT)
    alpha = np.where(grown, np.float32(1), np.where(support, mask, np.float32(0)))
    solid = alpha > _SOLID
    outside = ~support
    rim = outside & _grown(solid, _CROSS) & _hard(alpha, support)
    edge = solid & _grown(outside, _CROSS) & _hard(alpha, support) & ~grown
    soft = support & ~edge & ~grown & _grown(outside, _WIDE) & _grown(solid, _WIDE) & ~_hard(alpha, support)
    unsure = rim | edge | soft
    alpha[grown] = share_of_line(image, plate, support, grown, faintest=_LEAST_CONTRAST)
    if not unsure.any():
        return alpha
    way, difference = (_inner_colour(image, support) - plate)[unsure], (image - plate)[unsure]
    length = np.linalg.norm(way, axis=1)
    distance = np.linalg.norm(difference, axis=1)
    along = np.einsum("ij,ij->i", difference, way) / np.maximum(length, 1e-6)
    share = np.clip(np.where(rim[unsure], along, distance) / np.maximum(length, 1e-6), 0, 1)
    given = alpha[unsure]
    # A soft edge's small differences from its mask are the background's texture.
    doubt = np.clip((np.abs(share - given) - _TRUST) / (_DISBELIEF - _TRUST), 0, 1)
    weight = np.where(soft[unsure], doubt, np.where(rim[unsure], share > _LEAST_SHARE, 1))
    # Between colours too close to measure it, the share does not show: the mask's word stands.
    weight = np.where(length > _LEAST_CONTRAST, weight, 0)
    alpha[unsure] = given + weight * (share - given)
    return alpha


def fitting_plate(image: FloatImage, plate: FloatImage, alpha: FloatImage) -> FloatImage:
    """The plate changed as little as needed for a real colour over it to give the picture.

    I = alpha F + (1 - alpha) B with F in 0 to 1 needs (I - alpha) / (1 - alpha) <= B <= I / (1 - alpha), where I is
    known to half of one of 255 levels. Were alpha raised instead, slight errors of the plate would make light or dark
    fringes that move with the part.

    Args:
        image: I, RGB in 0 to 1, shape [h, w, 3].
        plate: B, RGB in 0 to 1, shape [h, w, 3].
        alpha: in 0 to 1, shape [h, w].

    Returns:
        The plate where alpha is above 0, the picture elsewhere; shape [h, w, 3].
    """
    fitting = np.where(alpha[..., None] > 0, plate, image)
    at = np.nonzero((alpha > 0) & (alpha < 1))
    share = alpha[at][:, None]
    # The plate will be rounded as well, and shows by 1 - alpha.
    slack = np.maximum(_ROUNDING - (1 - share) * np.float32(0.5 / 255), 0)
    lowest, highest = (image[at] - slack - share) / (1 - share), (image[at] + slack) / (1 - share)
    fitting[at] = np.clip(np.clip(plate[at], lowest, highest), 0, 1)
    return fitting


def window_around(mask: Mask, *, margin: int) -> tuple[slice, slice]:
    """Rows and columns of the true pixels and of ``margin`` more on every side, within the picture."""
    left, top, width, height = cv2.boundingRect(mask.astype(np.uint8))
    return (
        slice(max(0, top - margin), min(mask.shape[0], top + height + margin)),
        slice(max(0, left - margin), min(mask.shape[1], left + width + margin)),
    )


def _hard(mask: FloatImage, support: Mask) -> Mask:
    """Where the nearby edge of a mask is hard."""
    return _mean_near(mask, support & _grown(~support, _CROSS))[0] > _HARD


def _mean_near(values: FloatImage, where: Mask) -> tuple[FloatImage, Mask]:
    """Mean value of the nearby pixels in ``where``, and where there are any."""
    weight = where.astype(np.float32)
    total = cv2.GaussianBlur(weight, (0, 0), _SIGMA)
    return cv2.GaussianBlur(values * weight, (0, 0), _SIGMA) / np.maximum(total, 1e-6), total > 1e-3


def _joined(inside: Mask, outline: Mask, reach: int) -> Mask:
    """The part with the outline pixels that hang together with it; without the specks that they enclose."""
    joined = inside.copy()
    for _ in range(reach):
        joined |= outline & _grown(joined, _SQUARE)
    # The line's outermost pixels are too faint to be told by their lightness.
    added = _grown(joined & ~inside, _SQUARE)
    joined |= added
    _, labels, statistics, _ = cv2.connectedComponentsWithStats((~joined).astype(np.uint8), connectivity=4)
    small = statistics[:, cv2.CC_STAT_AREA] < _SPECK
    small[0] = False
    return joined | (small[labels] & _grown(added, _SQUARE))


def _inner_colour(image: FloatImage, support: Mask) -> FloatImage:
    """For every pixel the colour of the nearest one that lies at least two pixels inside."""
    depth = cv2.distanceTransform(support.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    ridge = cv2.dilate(depth, _SQUARE) == depth
    core = support & ((depth >= 2) | ridge)
    _, labels = cv2.distanceTransformWithLabels(
        (~core).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    colours = np.zeros((int(labels.max()) + 1, 3), dtype=np.float32)
    colours[labels[core]] = image[core]
    return colours[labels]


def _grown(mask: Mask, shape: NDArray[np.uint8]) -> Mask:
    return cv2.dilate(mask.astype(np.uint8), shape) > 0
