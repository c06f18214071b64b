"""How much of each pixel of a drawn outline is the line: its rim shows the background through."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["share_of_line"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# The colour of an outline is looked for this far [px], among colours whose direction from the background's is as alike
# as this cosine; what comes this near to it is the line's alone.
_LINE_REACH = 2
_ALIKE = 0.9
_FULL = 0.9


def share_of_line(
    image: FloatImage, plate: FloatImage, support: Mask, line: Mask, *, faintest: float
) -> NDArray[np.float32]:
    """Share of an outline in each of its pixels: |I - B| / |F - B|.

    F is the colour near by that lies furthest from the background in the direction of the pixel's own.

    Args:
        image: I, RGB in 0 to 1, shape [h, w, 3].
        plate: B, what is behind the outline, shape [h, w, 3].
        support: where the part and its outline are, shape [h, w].
        line: the outline's pixels, some of which may show nothing of it, shape [h, w].
        faintest: a line differs at least this much from what is behind it [distance of colours].

    Returns:
        Shares in 0 to 1, in the order of the line's pixels, shape [n].
    """
    row, column = np.nonzero(line)
    behind = plate[row, column]
    difference = image[row, column] - behind
    length = np.linalg.norm(difference, axis=1)
    fullest = np.maximum(length, np.float32(faintest))
    for down in range(-_LINE_REACH, _LINE_REACH + 1):
        for right in range(-_LINE_REACH, _LINE_REACH + 1):
            y, x = np.clip(row + down, 0, line.shape[0] - 1), np.clip(column + right, 0, line.shape[1] - 1)
            way = image[y, x] - behind
            far = np.linalg.norm(way, axis=1)
            alike = np.einsum("ij,ij->i", difference, way) > _ALIKE * length * far
            fullest = np.where(support[y, x] & alike, np.maximum(fullest, far), fullest)
    # No less than what gives a colour that exists.
    room = np.where(difference < 0, behind, 1 - behind)
    least = (np.abs(difference) / np.maximum(room, np.float32(1e-3))).max(axis=1)
    return np.asarray(np.clip(np.maximum(length / (_FULL * fullest), least), 0, 1), dtype=np.float32)
