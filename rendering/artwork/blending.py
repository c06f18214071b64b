"""How one layer is laid over another: the separable blend modes with alpha, as painting programs have them.

Source: W3C, Compositing and Blending Level 1, section 5, which is that of PDF:
"co = cs as (1 - ab) + cb ab (1 - as) + as ab B(cb, cs)". With colours that are multiplied by their alpha, every mode
here does without a division.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .artwork import Blend

__all__ = ["lay_over", "planes_of"]

FloatImage = NDArray[np.float32]


def lay_over(planes: FloatImage, layer: FloatImage, blend: Blend = "normal") -> None:
    """Lay a layer over what is there, in place.

    Args:
        planes: RGBA of what is below, colours times alpha, sRGB values from 0 to 1, shape [h, w, 4]; changed.
        layer: of the same form and shape.
        blend: the mode.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import lay_over
        >>> below = np.array([[[0.5, 0.5, 0.5, 1]]], np.float32)
        >>> lay_over(below, np.array([[[0.5, 0, 1, 1]]], np.float32), "multiply")
        >>> below.tolist()
        [[[0.25, 0.0, 0.5, 1.0]]]
    """
    above, below = layer[..., 3:], planes[..., 3:]
    if blend == "normal":
        planes *= 1 - above
        planes += layer
        return
    colours = planes[..., :3]
    mixed = _mixed(colours, below, layer[..., :3], above, blend)
    colours *= 1 - above
    colours += layer[..., :3] * (1 - below)
    colours += mixed
    below += above * (1 - below)


def _mixed(below: FloatImage, there: FloatImage, above: FloatImage, alpha: FloatImage, blend: Blend) -> FloatImage:
    """B(cb, cs) times both alphas, from colours that are multiplied by theirs."""
    if blend == "multiply":
        return below * above
    if blend == "screen":
        return below * alpha + above * there - below * above
    both = there * alpha
    if blend == "add":
        return np.minimum(below * alpha + above * there, both)
    dark = 2 * below <= there
    return np.where(dark, 2 * below * above, both - 2 * (there - below) * (alpha - above))


def planes_of(pixels: NDArray[Any], opacity: float = 1.0) -> FloatImage:
    """Straight RGBA of whole numbers as colours times alpha: float32 in 0 to 1, shape [h, w, 4].

    Args:
        pixels: uint8 or uint16, shape [h, w, 4].
        opacity: of all of it, 0 to 1.
    """
    planes = pixels.astype(np.float32)
    planes /= np.float32(np.iinfo(pixels.dtype).max)
    if opacity != 1:
        planes[..., 3] *= np.float32(opacity)
    planes[..., :3] *= planes[..., 3:]
    return planes
