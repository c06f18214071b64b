"""Pictures as arrays: the forms that the renderers accept, and the one that they work in."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..physics.errors import InvalidInputError

__all__ = ["as_dtype", "as_float", "check_picture"]

FloatImage = NDArray[np.float32]


def check_picture(image: NDArray[Any]) -> None:
    """Raise unless an array is an RGB picture of uint8 or float32.

    Raises:
        InvalidInputError: it is not.
    """
    if image.ndim != 3 or image.shape[2] != 3 or image.size == 0:
        raise InvalidInputError(f"image must have the shape [height, width, 3]. Got: {image.shape}")
    if image.dtype not in (np.uint8, np.float32):
        raise InvalidInputError(f"image must be uint8 or float32. Got: {image.dtype}")


def as_float(image: NDArray[Any]) -> FloatImage:
    """A uint8 or float32 picture as float32 in 0 to 1."""
    return image.astype(np.float32) / np.float32(255) if image.dtype == np.uint8 else image.astype(np.float32)


def as_dtype(image: FloatImage, dtype: np.dtype[Any]) -> NDArray[Any]:
    """A float32 picture in 0 to 1 as uint8 or float32."""
    image = np.clip(image, 0, 1)
    return np.rint(image * 255).astype(np.uint8) if dtype == np.uint8 else image
