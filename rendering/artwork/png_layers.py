"""Pictures of layers: PNG files, from disk or out of an archive, as straight RGBA."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import IO, TYPE_CHECKING, Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, PhysAnimatorError
from .artwork import ArtLayer
from .limits import MAX_PICTURE_BYTES, check_canvas

if TYPE_CHECKING:
    from PIL import Image

__all__ = ["as_one_dtype", "picture_of", "trimmed"]

_SIXTEEN_BITS_AT = 24
"""Where a PNG file says how many bits a channel has."""


def picture_of(file: IO[bytes], name: str, remarks: list[str]) -> NDArray[Any]:
    """Straight RGBA of a PNG file: uint16 if it has 16 bits a channel, otherwise uint8, shape [h, w, 4], in sRGB.

    Args:
        file: of the picture; not read beyond ``MAX_PICTURE_BYTES``.
        name: what the user calls it.
        remarks: gets a sentence where its colours are not converted exactly.

    Raises:
        InvalidInputError: it is no PNG file, damaged, or too large.
    """
    data = file.read(MAX_PICTURE_BYTES + 1)
    if len(data) > MAX_PICTURE_BYTES:
        raise InvalidInputError(f"{name} must have at most {MAX_PICTURE_BYTES / 2**20:.0f} MiB. Got: more")
    if data[:8] != b"\x89PNG\r\n\x1a\n" or len(data) <= _SIXTEEN_BITS_AT:
        raise InvalidInputError(f"{name} must be a PNG file. Got: something else")
    width, height = int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")
    check_canvas(width, height, name)
    from ..pictures.colour_profiles import as_srgb

    try:
        with _opened(data) as picture:
            profile = picture.info.get("icc_profile")
            sixteen = data[_SIXTEEN_BITS_AT] == 16
            pixels = _of_16_bits(data, name) if sixteen else np.array(picture.convert("RGBA"))
        if isinstance(profile, bytes) and profile:
            pixels, remark = as_srgb(pixels, profile)
            remarks += [f"{name}: {remark}"] if remark else []
        return pixels
    except (PhysAnimatorError, MemoryError):
        raise
    except Exception as error:  # a damaged file makes the readers raise nearly anything
        raise InvalidInputError(f"{name} cannot be read: it is damaged") from error


@contextmanager
def _opened(data: bytes) -> Iterator[Image.Image]:
    from PIL import Image

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
            yield picture


def _of_16_bits(data: bytes, name: str) -> NDArray[Any]:
    pixels = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)  # Pillow has no colours of 16 bits
    if pixels is None or pixels.dtype != np.uint16:
        raise InvalidInputError(f"{name} cannot be read: it is damaged")
    if pixels.ndim == 2:
        pixels = np.repeat(pixels[..., None], 3, axis=2)
    result = np.full((*pixels.shape[:2], 4), 65535, np.uint16)
    result[..., :3] = pixels[..., 2::-1]
    if pixels.shape[2] == 4:
        result[..., 3] = pixels[..., 3]
    return result


def trimmed(layer: ArtLayer) -> ArtLayer:
    """A layer without the empty rows and columns around what is drawn."""
    there = layer.pixels[..., 3] > 0
    rows, columns = np.flatnonzero(there.any(axis=1)), np.flatnonzero(there.any(axis=0))
    if not rows.size:
        return replace(layer, pixels=layer.pixels[:0, :0].copy())
    top, bottom, left, right = rows[0], rows[-1] + 1, columns[0], columns[-1] + 1
    if (bottom - top, right - left) == there.shape:
        return layer
    part = layer.pixels[top:bottom, left:right].copy()
    return replace(layer, pixels=part, left=layer.left + int(left), top=layer.top + int(top))


def as_one_dtype(layers: list[ArtLayer]) -> tuple[ArtLayer, ...]:
    """Layers of 16 bits, where one of them has so many."""
    if len({layer.pixels.dtype for layer in layers}) < 2:
        return tuple(layers)
    return tuple(
        layer
        if layer.pixels.dtype == np.uint16
        else replace(layer, pixels=layer.pixels.astype(np.uint16) * np.uint16(257))
        for layer in layers
    )
