"""Alpha raised where what is behind cannot be what a share says that shows through."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["INEXPLICABLE", "raised_alpha"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

INEXPLICABLE = 0.4
"""Further than this from the colour that it would need, what is behind does not explain a pixel of the mask."""


def raised_alpha(image: FloatImage, plate: FloatImage, alpha: FloatImage, where: Mask, *, beyond: float) -> FloatImage:
    """Alpha raised to the least that gives a real colour, where the plate would have to be of quite another colour.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        plate: what is behind the part, shape [h, w, 3].
        alpha: in 0 to 1, shape [h, w].
        where: the pixels in question, shape [h, w].
        beyond: change of any of the plate's colours that is too much, in 0 to 1.

    Returns:
        Alpha in 0 to 1, shape [h, w].
    """
    row, column = np.nonzero(where)
    colour, behind = image[row, column], plate[row, column]
    given = alpha[row, column]
    room = np.where(colour < behind, behind, 1 - behind)
    least = (np.abs(colour - behind) / np.maximum(room, np.float32(1e-3))).max(axis=1)
    # With the given share, what is behind would have to be of this colour.
    rest = np.maximum(1 - given, np.float32(1e-3))[:, None]
    needed = np.clip(behind, (colour - 1 + rest) / rest, colour / rest)
    change = np.abs(needed - behind).max(axis=1)
    raised = alpha.copy()
    raised[row, column] = np.where(change > beyond, np.maximum(np.minimum(least, 1), given), given)
    return raised
