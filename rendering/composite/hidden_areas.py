"""Where what stands still hides all that moves behind it: triangles that are wholly there need not be drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from .still_layers import StillLayer

__all__ = ["HiddenArea", "hidden_areas"]

# Looked at in squares of so many pixels a side, which takes a sixteenth of the memory.
_BLOCK = 4
# Edges of what is seen are drawn by what is beside them.
_BESIDE = 2


@dataclass(frozen=True, eq=False)
class HiddenArea:
    """Squares of a picture in which nothing behind is seen.

    Attributes:
        before: how many hidden squares are above and left of each corner, shape [rows + 1, columns + 1].
    """

    before: NDArray[np.int32]

    @classmethod
    def of(cls, hidden: NDArray[np.bool_]) -> HiddenArea | None:
        """The area of hidden pixels, shape [h, w]; None where no square is hidden."""
        height, width = hidden.shape
        # What is beyond the picture is not seen either.
        whole = np.pad(hidden, ((0, -height % _BLOCK), (0, -width % _BLOCK)), constant_values=True)
        rows, columns = (side // _BLOCK for side in whole.shape)
        blocks = whole.reshape(rows, _BLOCK, columns, _BLOCK).all(axis=(1, 3))
        return cls(cv2.integral(blocks.view(np.uint8))) if blocks.any() else None

    def seen(self, points: NDArray[np.float64], triangles: NDArray[np.integer]) -> NDArray[np.integer]:
        """The triangles of which something may be seen, in their order.

        Args:
            points: positions of the vertices [px], shape [v, 2].
            triangles: shape [t, 3].
        """
        bounds = []
        for places, end in zip(points.T, self.before.shape[::-1], strict=True):
            a, b, c = (places.take(corner) for corner in triangles.T)
            low = np.floor((np.minimum(np.minimum(a, b), c) - _BESIDE) / _BLOCK)
            high = np.ceil((np.maximum(np.maximum(a, b), c) + _BESIDE) / _BLOCK)
            bounds.append([np.clip(each, 0, end - 1).astype(np.int64) for each in (low, high)])
        (left, right), (top, bottom) = bounds
        before = self.before
        hidden = before[bottom, right] - before[top, right] - before[bottom, left] + before[top, left]
        return triangles[hidden < (right - left) * (bottom - top)]


def hidden_areas(layers: Sequence[StillLayer | None], width: int, height: int) -> list[HiddenArea | None]:
    """Where each layer that moves is hidden by those that stand still before it; None for nowhere.

    Args:
        layers: from back to front, None for those that move.
        width: of the picture [px].
        height: of the picture [px].

    Returns:
        One for each of the layers, None for those that stand still.
    """
    opaque = np.zeros((height, width), dtype=bool)
    areas: list[HiddenArea | None] = []
    for layer in reversed(layers):
        areas.append(HiddenArea.of(opaque) if layer is None else None)
        if layer is not None and layer.blend == "normal":
            opaque[layer.box.slices] |= layer.texture[..., -1] >= 1
    return areas[::-1]
