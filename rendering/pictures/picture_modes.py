"""What a picture's mode, transparency and colour profile mean, brought to 8 bits of sRGB with opacity."""

from __future__ import annotations

import io
import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...physics.arrays import OVERSHOOT
from ...physics.errors import InvalidInputError

if TYPE_CHECKING:
    from PIL import Image

__all__ = ["GREY_MODES", "grey_numbers", "has_transparency", "in_8_bits", "in_srgb", "with_opacity"]

StrPath = str | os.PathLike[str]

GREY_MODES = ("I", "F", "I;16", "I;16L", "I;16B", "I;16N")
"""Pillow's modes of one plane with more than 8 bits."""

_LEAST_OF_RANGE = 16  # the part of a range that values reach is at least one by this


def has_transparency(picture: Image.Image) -> bool:
    """Whether a picture says anywhere how opaque it is."""
    return picture.mode in ("LA", "La", "PA", "RGBA", "RGBa") or "transparency" in picture.info


def with_opacity(picture: Image.Image, *, name: str = "picture") -> Image.Image:
    """RGB and opacity of a picture that has transparency, 8 bits each."""
    from PIL import Image

    reduced = in_8_bits(picture, name=name)
    if reduced is picture:
        return picture.convert("RGBA")
    # One of the 65536 greys means transparent; after the reduction others would be equal to it.
    opacity = np.where(np.array(picture) == picture.info["transparency"], 0, 255).astype(np.uint8)
    return Image.merge("RGBA", [*[reduced.convert("L")] * 3, Image.fromarray(opacity)])


def in_8_bits(picture: Image.Image, *, name: str = "picture") -> Image.Image:
    """The picture with 16-bit, 32-bit or float grey values brought to 0..255 (Pillow would clip them).

    Raises:
        InvalidInputError: see :func:`grey_numbers`.
    """
    from PIL import Image

    if picture.mode not in GREY_MODES:
        return picture
    return Image.fromarray(np.rint(grey_numbers(picture, name=name) * 255).astype(np.uint8))


def grey_numbers(picture: Image.Image, *, name: str = "picture") -> NDArray[Any]:
    """The values of a picture of one of ``GREY_MODES`` as 0 to 1, shape [h, w].

    16-bit files reach to 65535. 32-bit files are written with any range: the smallest of 0 to 1 (of fractions), 255,
    65535 and 2^31 - 1 that holds all values is taken, if they reach a sixteenth of it: of others, such as 0 to 4095,
    nothing tells whether they are nearly black or of a range of their own.

    Raises:
        InvalidInputError: a value is not finite, negative, or the range cannot be told.
    """
    values = np.array(picture).astype(np.float64)
    low, high = float(values.min()), float(values.max())  # NaN if any value is
    if not (np.isfinite(low) and np.isfinite(high)):
        raise InvalidInputError(f"{name} must hold finite numbers. Got: NaN or infinity")
    fractions = picture.mode == "F"
    ranges: tuple[float, ...] = (1.0, 255.0, 65535.0) if fractions else (255.0, 65535.0, 2.0**31 - 1)
    if picture.mode.startswith("I;16") or picture.format == "PNG":
        ranges = (65535.0,)
    fitting = [each for each in ranges if high <= each * (1 + OVERSHOOT if fractions and each == 1 else 1)]
    unclear = bool(fitting) and fitting[0] > ranges[0] and high < fitting[0] / _LEAST_OF_RANGE
    if low < (-OVERSHOOT if fractions else 0) or unclear or not fitting:
        known = [f"0 to {each:.0f}" for each in ranges]
        of = f"{', '.join(known[:-1])} or {known[-1]}" if known[1:] else known[0]
        reaching = ", and reach a sixteenth of that" if unclear else ""
        raise InvalidInputError(f"{name} must hold numbers from {of}{reaching}. Got: {low:.6g} to {high:.6g}")
    return np.clip(values / fitting[0], 0.0, 1.0)


def in_srgb(picture: Image.Image, *, name: str = "picture") -> Image.Image:
    """The picture's colours as sRGB values; drawing tablets embed wider profiles such as Display P3.

    One with a profile comes back as RGB or RGBA of 8 bits, whatever mode it had, unless it is sRGB already.
    """
    from PIL import Image, ImageCms

    from .colour_profiles import as_srgb, is_srgb

    if picture.mode == "LAB":
        lab = ImageCms.createProfile("LAB")
        return ImageCms.profileToProfile(picture, lab, ImageCms.createProfile("sRGB"), outputMode="RGB") or picture
    profile = picture.info.get("icc_profile")
    if not isinstance(profile, bytes) or not profile:
        return picture
    if picture.mode == "CMYK":
        return _from_cmyk(picture, profile)
    if is_srgb(profile):
        return picture
    plain = with_opacity(picture, name=name) if has_transparency(picture) else in_8_bits(picture, name=name)
    pixels = np.asarray(plain if plain.mode == "RGBA" else plain.convert("RGB"))
    converted, _ = as_srgb(pixels, profile)
    return picture if converted is pixels else Image.fromarray(converted)


def _from_cmyk(picture: Image.Image, profile: bytes) -> Image.Image:
    from PIL import ImageCms

    try:
        source = ImageCms.ImageCmsProfile(io.BytesIO(profile))
        converted = ImageCms.profileToProfile(picture, source, ImageCms.createProfile("sRGB"), outputMode="RGB")
    except (ImageCms.PyCMSError, OSError, ValueError, TypeError):
        return picture
    return picture if converted is None else converted
