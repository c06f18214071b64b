"""Pictures as arrays: the one place where what callers hand over becomes the forms that everything else works in."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.arrays import OVERSHOOT, as_array, beyond_one
from ...physics.errors import InvalidInputError, require

__all__ = ["as_dtype", "as_float", "as_grey", "as_picture", "as_uint8", "check_picture"]

FloatImage = NDArray[np.float32]


def as_picture(image: ArrayLike, *, name: str = "image", alpha: bool = False) -> NDArray[Any]:
    """A picture in one of the two forms that the renderers work in.

    Args:
        image: uint8, uint16 (0 to 65535), other whole numbers 0 to 255, bool, or floating-point numbers 0 to 1 of any
            precision, which may overshoot a little as resampling leaves them; a NumPy array, a tensor or a Pillow
            picture of shape [h, w, 3], and with ``alpha`` also [h, w, 4].
        name: what the caller calls the picture, for messages.
        alpha: whether RGBA is taken, too.

    Returns:
        The picture in its shape: uint8 where whole numbers to 255 were given, otherwise float32 in 0 to 1. Shares
        memory with ``image`` where nothing changes, so only read it.

    Raises:
        InvalidInputError: it has another shape, or values out of these ranges.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.pictures import as_picture
        >>> as_picture(np.full((4, 6, 3), 65535, np.uint16)).dtype
        dtype('float32')
    """
    pixels = as_array(image, name)
    wanted = "an RGB or RGBA picture of shape [h, w, 3 or 4]" if alpha else "an RGB picture of shape [h, w, 3]"
    right = pixels.ndim == 3 and pixels.shape[2] in ((3, 4) if alpha else (3,)) and pixels.size > 0
    require(name, f"shape {pixels.shape}", right, wanted)
    return _as_8_bits_or_float(pixels, name)


def check_picture(image: ArrayLike, *, name: str = "image", alpha: bool = False) -> None:
    """Raise unless :func:`as_picture` takes a picture.

    Raises:
        InvalidInputError: see there.
    """
    as_picture(image, name=name, alpha=alpha)


def as_float(image: ArrayLike, *, exact: bool = True) -> FloatImage:
    """Any picture of :func:`as_picture`, or one plane of it, as float32 in 0 to 1, in its own shape.

    Args:
        image: the picture.
        exact: divide by 255. Otherwise multiply by 1 / 255, which differs in the last bit of every other level: line
            drawings and in-betweens hang on that bit where a value lies half-way between two levels.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.pictures import as_float
        >>> as_float(np.array([[0, 255]], np.uint8)).tolist()
        [[0.0, 1.0]]
    """
    values = _as_8_bits_or_float(as_array(image, "image"), "image")
    if values.dtype != np.uint8:
        return values
    return values.astype(np.float32) / np.float32(255) if exact else values.astype(np.float32) * np.float32(1 / 255)


def as_grey(image: ArrayLike) -> FloatImage:
    """A grey picture, or the mean of a colour picture's channels, as float32 in 0 to 1, shape [h, w]."""
    values = as_float(image)
    return values if values.ndim == 2 else np.ascontiguousarray(values.mean(axis=2))


def as_uint8(image: ArrayLike, *, name: str = "image") -> NDArray[np.uint8]:
    """Any picture of :func:`as_picture`, or one plane of it, as 0 to 255, rounded, in its own shape.

    uint8 passes unchanged.

    Raises:
        InvalidInputError: values are out of range or not finite.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.pictures import as_uint8
        >>> as_uint8(np.array([[0.0, 0.2, 1.0]])).tolist()
        [[0, 51, 255]]
    """
    values = _as_8_bits_or_float(as_array(image, name), name)
    return values if values.dtype == np.uint8 else np.rint(values * np.float32(255)).astype(np.uint8)


def as_dtype(image: FloatImage, dtype: np.dtype[Any]) -> NDArray[Any]:
    """A float32 picture in 0 to 1, which may overshoot, as uint8 or in a floating-point type."""
    image = np.clip(image, 0, 1)
    if dtype != np.uint8:
        return image.astype(dtype, copy=False)
    image *= 255
    return np.rint(image, out=image).astype(np.uint8)


def _as_8_bits_or_float(values: NDArray[Any], name: str) -> NDArray[Any]:
    if values.dtype == np.uint8 or values.size == 0:
        return values
    if values.dtype == np.bool_:
        return values.astype(np.uint8) * np.uint8(255)
    if np.issubdtype(values.dtype, np.integer):
        return _from_whole_numbers(values, name)
    return _from_floats(values, name)


def _from_whole_numbers(values: NDArray[Any], name: str) -> NDArray[Any]:
    low, high = int(values.min()), int(values.max())
    if values.dtype.kind == "u" and values.dtype.itemsize == 2:
        if 0 < high <= 255:
            raise InvalidInputError(
                f"{name} of 16 bits must reach up to 65535; if it holds 8 bits, pass it as uint8. Got: at most {high}"
            )
        return values.astype(np.float32) / np.float32(65535)
    if low < 0 or high > 255:
        raise InvalidInputError(f"{name} must hold whole numbers from 0 to 255. Got: {low} to {high}")
    return values.astype(np.uint8)


def _from_floats(values: NDArray[Any], name: str) -> FloatImage:
    low, high = float(values.min()), float(values.max())  # NaN if any value is
    if not (np.isfinite(low) and np.isfinite(high)):
        raise InvalidInputError(f"{name} must hold finite numbers. Got: NaN or infinity")
    if low < -OVERSHOOT or high > 1 + OVERSHOOT:
        raise InvalidInputError(f"{name} must hold {beyond_one(low, high)}")
    result = values.astype(np.float32)
    return result if low >= 0 and high <= 1 else np.clip(result, 0, 1)
