"""Alpha measured pixel by pixel: where a colour lies between the background's and the part's."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .line_share import share_of_line
from .mask_edges import CROSS, FAINT, LEAST_CONTRAST, SOLID, WIDE, grown, hard_edge, inner_colour, trusted

__all__ = ["measured_alpha"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# A smaller share of a pixel outside the mask is taken for the background's own texture.
_LEAST_SHARE = 0.06


def measured_alpha(image: FloatImage, plate: FloatImage, mask: FloatImage, support: Mask) -> FloatImage:
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
    line = support & (mask <= FAINT)
    alpha = np.where(line, np.float32(1), np.where(support, mask, np.float32(0)))
    solid = alpha > SOLID
    outside = ~support
    rim = outside & grown(solid, CROSS) & hard_edge(alpha, support)
    edge = solid & grown(outside, CROSS) & hard_edge(alpha, support) & ~line
    soft = support & ~edge & ~line & grown(outside, WIDE) & grown(solid, WIDE) & ~hard_edge(alpha, support)
    unsure = rim | edge | soft
    alpha[line] = share_of_line(image, plate, support, line, faintest=LEAST_CONTRAST)
    if not unsure.any():
        return alpha
    way, difference = (inner_colour(image, support) - plate)[unsure], (image - plate)[unsure]
    length = np.linalg.norm(way, axis=1)
    distance = np.linalg.norm(difference, axis=1)
    along = np.einsum("ij,ij->i", difference, way) / np.maximum(length, 1e-6)
    share = np.clip(np.where(rim[unsure], along, distance) / np.maximum(length, 1e-6), 0, 1)
    given = alpha[unsure]
    weight = np.where(soft[unsure], trusted(given, share), np.where(rim[unsure], share > _LEAST_SHARE, 1))
    # Between colours too close to measure it, the share does not show: the mask's word stands.
    weight = np.where(length > LEAST_CONTRAST, weight, 0)
    alpha[unsure] = given + weight * (share - given)
    return alpha
