"""Alpha solved for along hard edges, by closed-form matting."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import window_around
from .closed_form import solve_alpha
from .line_share import share_of_line
from .mask_edges import FAINT, LEAST_CONTRAST, SOLID, SQUARE, WIDE, grown, hard_edge, inner_colour, trusted
from .raised_alpha import INEXPLICABLE, raised_alpha

__all__ = ["solved_alpha"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

_HALF = 0.5
_TRUST_IN_MASK = 0.03
_DISC = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (5, 5))


def solved_alpha(image: FloatImage, plate: FloatImage, mask: FloatImage, support: Mask) -> FloatImage:
    """Share of each pixel that belongs to a part.

    Along a hard edge of the mask, and on an outline found outside it, the share is what closed-form matting makes of
    the colours, starting from the mask and, beside it, from the share measured from the pixel's colour I, the
    background's B and the part's F from two pixels further inside, |I - B| / |F - B|. A soft edge is taken as it is,
    unless the share so measured is much smaller or larger.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        plate: what is behind the part, at least up to two pixels around ``support``; shape [h, w, 3].
        mask: soft mask in 0 to 1, shape [h, w].
        support: where the part is, from ``with_outline``; shape [h, w].

    Returns:
        Alpha in 0 to 1, shape [h, w].
    """
    line, outside = support & (mask <= FAINT), ~support
    alpha = np.where(line, np.float32(1), np.where(support, mask, np.float32(0)))
    if not support.any() or not outside.any():
        return alpha
    hard = hard_edge(alpha, support)
    alpha[line] = share_of_line(image, plate, support, line, faintest=LEAST_CONTRAST)
    body = mask > _HALF
    unknown = grown(support, SQUARE) & (grown(~body, _DISC) | ~body) & hard
    share, certain = _share(image, plate, support, unknown & ~body)
    guess = body.astype(np.float32)
    guess[unknown & ~body] = np.where(certain, share, 0)
    solved = _solved(image, alpha, unknown, guess)
    # Where a line behind the part meets its outline, both of the same ink, colours alone say that the outline goes on
    # in the line.
    raised = raised_alpha(image, plate, solved, body & unknown, beyond=INEXPLICABLE)
    return _corrected(image, plate, raised, support, ~hard)


def _solved(image: FloatImage, alpha: FloatImage, unknown: Mask, guess: FloatImage) -> FloatImage:
    """Alpha with its unknown pixels solved for, in the window that holds them."""
    if not unknown.any():
        return alpha
    window = window_around(unknown, margin=2)
    solved = alpha.copy()
    crops = image[window], alpha[window], unknown[window], guess[window]
    solved[window] = solve_alpha(*crops, trust=_TRUST_IN_MASK)
    return solved


def _corrected(image: FloatImage, plate: FloatImage, alpha: FloatImage, support: Mask, where: Mask) -> FloatImage:
    """Alpha with the soft edges put right that deny much of the picture."""
    outside = ~support
    soft = support & where & grown(outside, WIDE) & grown(alpha > SOLID, WIDE)
    if not soft.any():
        return alpha
    share, certain = _share(image, plate, support, soft)
    given = alpha[soft]
    # Between colours too close to measure it, the share does not show: the mask's word stands.
    corrected = alpha.copy()
    corrected[soft] = given + np.where(certain, trusted(given, share), 0) * (share - given)
    return corrected


def _share(
    image: FloatImage, plate: FloatImage, support: Mask, where: Mask
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """The share |I - B| / |F - B| of the pixels in ``where``, and which of them have contrast enough, shape [n]."""
    length = np.linalg.norm((inner_colour(image, support) - plate)[where], axis=1)
    difference = np.linalg.norm((image - plate)[where], axis=1)
    return np.clip(difference / np.maximum(length, 1e-6), 0, 1), length > LEAST_CONTRAST
