"""Artwork as one picture."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..pictures import straight
from .artwork import ArtLayer, Artwork
from .blending import lay_over, planes_of

__all__ = ["flattened", "laid_together"]

_BAND = 2**16
"""Pixels that are mixed at a time, so that a large canvas is never there as floating-point numbers."""


def flattened(artwork: Artwork, layers: Iterable[ArtLayer] | None = None) -> NDArray[Any]:
    """Visible layers laid over one another.

    Args:
        artwork: the artwork.
        layers: which of its layers to draw, from back to front; all of them when None. Hidden ones are left out.

    Returns:
        Straight RGBA, shape [height, width, 4], the artwork's dtype; zeros where nothing is drawn.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import ArtLayer, Artwork, flattened
        >>> white = np.full((1, 1, 4), 255, np.uint8)
        >>> half = ArtLayer("shade", white * np.uint8([0, 0, 0, 1]), opacity=0.5)
        >>> flattened(Artwork(1, 1, (ArtLayer("paper", white), half))).tolist()
        [[[128, 128, 128, 255]]]
    """
    return laid_together(
        artwork.layers if layers is None else layers, (0, 0, artwork.width, artwork.height), artwork.dtype
    )


def laid_together(layers: Iterable[ArtLayer], box: tuple[int, int, int, int], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Visible layers laid over one another in a box of the canvas.

    Args:
        layers: from back to front.
        box: left, top, right and bottom [px].
        dtype: uint8 or uint16.

    Returns:
        Straight RGBA, the size of the box.
    """
    left, top, right, bottom = box
    drawn = [layer for layer in layers if layer.visible]
    result = np.zeros((bottom - top, right - left, 4), dtype)
    rows = max(1, _BAND // max(1, right - left))
    for begin in range(top, bottom, rows):
        end = min(begin + rows, bottom)
        planes = np.zeros((end - begin, right - left, 4), np.float32)
        for layer in drawn:
            _draw(planes, layer, left, begin)
        result[begin - top : end - top] = as_whole_numbers(straight(planes), dtype)
    return result


def _draw(planes: NDArray[np.float32], layer: ArtLayer, left: int, top: int) -> None:
    """Lay the part of a layer that is in a box over the planes of the box."""
    height, width = planes.shape[:2]
    own_left, own_top, own_right, own_bottom = layer.box
    x0, x1 = max(left, own_left), min(left + width, own_right)
    y0, y1 = max(top, own_top), min(top + height, own_bottom)
    if x0 >= x1 or y0 >= y1:
        return
    part = layer.pixels[y0 - own_top : y1 - own_top, x0 - own_left : x1 - own_left]
    lay_over(planes[y0 - top : y1 - top, x0 - left : x1 - left], planes_of(part, layer.opacity), layer.blend)


def as_whole_numbers(values: NDArray[np.float32], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Numbers from 0 to 1 as uint8 or uint16, rounded."""
    return np.rint(values * np.float32(np.iinfo(dtype).max)).astype(dtype)
