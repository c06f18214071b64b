"""Pictures with an alpha channel, and what shows through them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .pixels import as_float

__all__ = ["WHITE", "Colour", "is_transparent", "over"]

Image = NDArray[Any]
Colour = tuple[int, int, int]

WHITE: Colour = (255, 255, 255)


def is_transparent(image: Image) -> bool:
    """Whether a picture has an alpha channel."""
    return image.ndim == 3 and image.shape[2] == 4


def over(image: Image, colour: Colour = WHITE) -> Image:
    """A picture laid over a colour.

    Args:
        image: RGB or straight RGBA, uint8 or 0..1 float, shape [h, w, 3] or [h, w, 4]; RGB comes back as it is.
        colour: red, green and blue, 0 to 255.

    Returns:
        RGB in the image's dtype, shape [h, w, 3].

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.pictures import over
        >>> over(np.array([[[255, 0, 0, 0]]], np.uint8)).tolist()
        [[[255, 255, 255]]]
    """
    if not is_transparent(image):
        return image
    if image.dtype == np.uint8:
        beneath = np.array(colour, dtype=np.float32)
        share = as_float(image[..., 3:])
        mixed = beneath + share * (image[..., :3].astype(np.float32) - beneath)
        return np.rint(mixed).astype(np.uint8)
    share, below = image[..., 3:], np.array(colour, dtype=image.dtype) / image.dtype.type(255)
    return np.asarray(share * image[..., :3] + (1 - share) * below)
