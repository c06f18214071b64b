"""Embedded colour profiles (ICC) applied: pixels of 8 and 16 bits, grey or in colours, become sRGB.

Profiles of a curve for each channel and a matrix, as those of monitors, tablets and working spaces are, are applied
here: see ``icc_curves``. Little CMS, by way of Pillow, applies the others, tables of printers and scanners. It has
no colours of 16 bits there, and in 8 it is some levels off where greys are dark, so that it is not asked to do all.
"""

from __future__ import annotations

import io
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .icc_curves import CurvesAndMatrix, curves_and_matrix

__all__ = ["as_srgb", "is_srgb"]

_ROWS = 256
"""Rows that are converted at once."""

_ALIKE = 1 / 512
"""How far a profile's colours may be from those of sRGB to count as these, from 0 to 1."""

_NOT_APPLIED = "the colour profile cannot be applied; convert the picture to sRGB in the painting program"
_COARSE = "the colour profile is one of tables: the 16-bit colours are converted as finely as 8 bits are"


def as_srgb(pixels: NDArray[Any], profile: bytes) -> tuple[NDArray[Any], str]:
    """Pixels in sRGB, and a sentence about what is not exact; empty where all is well.

    Args:
        pixels: uint8 or uint16, RGB or straight RGBA, shape [h, w, 3] or [h, w, 4]; grey ones have equal channels.
        profile: ICC profile of their colours, for RGB or grey.
    """
    if not pixels.size or is_srgb(profile):
        return pixels, ""
    exact = _exact(profile)
    if exact is not None:
        return _by_curves(pixels, exact), ""
    eight = pixels if pixels.dtype == np.uint8 else np.rint(pixels / np.float32(257)).astype(np.uint8)
    converted = _by_little_cms(eight, profile)
    if converted is None:
        return pixels, _NOT_APPLIED
    if pixels.dtype == np.uint8:
        return converted, ""
    result = pixels.copy()  # the alpha stays as fine as it is
    result[..., :3] = converted[..., :3].astype(np.uint16) * np.uint16(257)
    return result, _COARSE


@lru_cache(maxsize=8)
def is_srgb(profile: bytes) -> bool:
    """Whether colours of a profile are those of sRGB already; of two of one name one may be linear."""
    exact = _exact(profile)
    if exact is not None:
        colours = np.linspace(0, 65535, 9).astype(np.uint16)
        grid = np.stack(np.meshgrid(colours, colours, colours, indexing="ij"), axis=-1).reshape(1, -1, 3)
        if exact.grey:
            grid = np.repeat(grid[..., :1], 3, axis=2)
        away = np.abs(_by_curves(grid, exact).astype(np.int64) - grid.astype(np.int64)).max()
        return bool(away <= 65535 * _ALIKE)
    from PIL import ImageCms

    try:
        return "srgb" in ImageCms.getProfileDescription(ImageCms.ImageCmsProfile(io.BytesIO(profile))).lower()
    except (ImageCms.PyCMSError, OSError, ValueError, TypeError):
        return False


@lru_cache(maxsize=8)
def _exact(profile: bytes) -> CurvesAndMatrix | None:
    return curves_and_matrix(profile)


@lru_cache(maxsize=1)
def _of_srgb() -> CurvesAndMatrix:
    from PIL import ImageCms

    own = curves_and_matrix(ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes())
    assert own is not None
    return own


def _by_curves(pixels: NDArray[Any], profile: CurvesAndMatrix) -> NDArray[Any]:
    """RGB or RGBA in sRGB."""
    matrix = None if profile.grey else (np.linalg.inv(_of_srgb().matrix) @ profile.matrix).astype(np.float32)
    most = np.iinfo(pixels.dtype).max
    curves = [curve[:: 65535 // most] for curve in profile.curves]
    result = pixels.copy()
    for top in range(0, len(pixels), _ROWS):
        rows = pixels[top : top + _ROWS, :, :3]
        light = np.stack([curve[rows[..., k]] for k, curve in enumerate(curves)], axis=-1)
        if matrix is not None:
            light = light @ matrix.T
        result[top : top + _ROWS, :, :3] = np.rint(_encoded(np.clip(light, 0, 1)) * np.float32(most))
    return result


def _encoded(light: NDArray[np.float32]) -> NDArray[np.float32]:
    """Light as values of sRGB (IEC 61966-2-1), both 0 to 1."""
    curved = np.float32(1.055) * np.maximum(light, np.float32(0.0031308)) ** np.float32(1 / 2.4) - np.float32(0.055)
    return np.where(light <= 0.0031308, light * np.float32(12.92), curved)


def _by_little_cms(pixels: NDArray[np.uint8], profile: bytes) -> NDArray[np.uint8] | None:
    """RGB or RGBA of 8 bits in sRGB; None where the profile cannot be read, or is for colours of another kind."""
    from PIL import Image, ImageCms

    try:
        source, target = ImageCms.ImageCmsProfile(io.BytesIO(profile)), ImageCms.createProfile("sRGB")
        grey = source.profile.xcolor_space.strip() == "GRAY"
        picture = Image.fromarray(np.ascontiguousarray(pixels[..., 0] if grey else pixels[..., :3]))
        converted = ImageCms.profileToProfile(picture, source, target, outputMode="RGB")
    except (ImageCms.PyCMSError, OSError, ValueError, TypeError):
        return None
    if converted is None:
        return None
    result = pixels.copy()
    result[..., :3] = np.asarray(converted)
    return result
