"""Which kinds of picture files can be written, found by trying."""

from __future__ import annotations

import io
import warnings
from functools import lru_cache

from ...physics.errors import InvalidInputError
from ..files import StrPath, suffix_of

__all__ = ["check_picture_format"]

_LONGEST = {"JPEG": 65_500, "WEBP": 16_383, "GIF": 65_535, "TGA": 65_535, "PCX": 65_535}
"""Longest side of formats that hold no larger picture [px]."""

_TRIED = (300, 2)
"""Wider than icons, which would be made smaller without a word [px]."""


def check_picture_format(path: StrPath, *, mode: str, size: tuple[int, int] | None = None) -> str:
    """Refuse endings under which a picture cannot be written as it is.

    Args:
        path: of the file; its ending names the format.
        mode: the picture's mode in Pillow's terms, such as RGB.
        size: the picture's width and height [px], where they are known.

    Returns:
        Pillow's name of the format.

    Raises:
        InvalidInputError: the ending is unknown, or the format holds no such picture.
    """
    from PIL import Image

    kind = Image.registered_extensions().get(suffix_of(path), "")
    if not kind or not _holds(kind, "RGB"):
        raise InvalidInputError(f"a picture's name must end in .png, .jpg or .webp. Got: {path}")
    if not _holds(kind, mode):
        raise InvalidInputError(
            f"a picture with transparency must end in .png, .webp or .tif. Got: {path}"
            if mode.endswith("A")
            else f"a picture of mode {mode} must end in .png, .jpg or .webp. Got: {path}"
        )
    longest = _LONGEST.get(kind)
    if size is not None and longest is not None and max(size) > longest:
        raise InvalidInputError(
            f"{kind} pictures must be at most {longest} px on a side. Got: {size[0]} x {size[1]} px"
        )
    return kind


@lru_cache(maxsize=256)
def _holds(kind: str, mode: str) -> bool:
    """Whether Pillow writes pictures of a mode in a format, in their own size."""
    from PIL import Image, UnidentifiedImageError

    if kind not in Image.SAVE:
        return False
    file = io.BytesIO()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            Image.new(mode, _TRIED).save(file, format=kind)
            with Image.open(file) as again:
                return again.size == _TRIED and (mode != "RGBA" or again.has_transparency_data)
    except UnidentifiedImageError:
        return True  # a format that Pillow writes and does not read, such as PDF
    except Exception:  # whatever the writer of a format stumbles over: it cannot be used
        return False
