"""Picture files as Pillow reads them, opened without trust."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ...physics.errors import InvalidInputError, PhysAnimatorError
from ...physics.limits import MAX_PICTURE_PIXELS, MAX_PICTURE_SIDE
from ..files import check_regular

if TYPE_CHECKING:
    from PIL import Image

__all__ = ["check_size", "first_of_several", "open_picture", "reading"]

StrPath = str | os.PathLike[str]


# Formats of still pictures that are only data: no page descriptions, for which Pillow would start another program.
_FORMATS = (
    *(
        "PNG",
        "JPEG",
        "WEBP",
        "TIFF",
        "GIF",
        "BMP",
        "DIB",
        "ICO",
        "ICNS",
        "PSD",
        "TGA",
        "PPM",
        "PCX",
        "SGI",
        "DDS",
        "QOI",
    ),
    *("AVIF", "JPEG2000", "MPO"),
)


def open_picture(path: StrPath, *, name: str = "picture") -> Image.Image:
    """The first frame of a picture file, upright.

    Args:
        path: the file.
        name: what the user calls it, for messages.

    Raises:
        InvalidInputError: there is no such file, it is no picture, it is damaged or too large, or a pipe or device.
    """
    from PIL import ImageOps

    with reading(path, name) as opened:
        return ImageOps.exif_transpose(opened)


@contextmanager
def reading(path: StrPath, name: str) -> Iterator[Image.Image]:
    """A picture file whose size is known and in bounds; whatever damage is met on the way is said in one sentence.

    Raises:
        InvalidInputError: see :func:`open_picture`.
    """
    from PIL import Image, UnidentifiedImageError

    check_regular(path, name)
    try:
        # Pillow warns of large pictures below our own limit, and of damage that it can read past.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with _opened(path) as picture:
                check_size(path, picture.size, name)
                yield picture
    except PhysAnimatorError:
        raise
    except FileNotFoundError:
        raise InvalidInputError(f"{name} must be an existing file. Got: {path}") from None
    except Image.DecompressionBombError:
        raise InvalidInputError(f"{name} {path} must be {_BOUNDS}. Got: more") from None
    except UnidentifiedImageError:
        raise InvalidInputError(f"{name} must be a PNG, JPEG or WebP file. Got: {path}") from None
    except OSError as error:
        if error.strerror is None:  # Pillow's own, about what is in the file
            raise InvalidInputError(f"{name} {path} cannot be read: {_reason(error)}") from error
        raise InvalidInputError(f"{name} must be a readable file. Got: {path}: {error.strerror}") from None
    except Exception as error:  # a damaged file makes Pillow's readers raise nearly anything
        raise InvalidInputError(f"{name} {path} cannot be read: {_reason(error)}") from error


def _opened(path: StrPath) -> Image.Image:
    """A picture file; Pillow's readers of rarer formats, which take a while to load, are asked where usual ones fail.

    Raises:
        UnidentifiedImageError: it is none of these.
    """
    from PIL import Image, UnidentifiedImageError

    Image.preinit()
    usual = [each for each in _FORMATS if each in Image.OPEN]
    try:
        return Image.open(path, formats=usual)
    except UnidentifiedImageError:
        Image.init()
        return Image.open(path, formats=[each for each in _FORMATS if each in Image.OPEN and each not in usual])


def first_of_several(picture: Image.Image, called: str) -> tuple[str, ...]:
    """A sentence about a picture of which only the first frame or page is read; none where it is the only one.

    Args:
        picture: as it was opened; it shows its first frame again afterwards.
        called: its name, for the sentence.
    """
    if picture.format not in _SEVERAL:
        return ()
    try:
        picture.seek(1)
    except Exception:  # there is none, or it is damaged
        return ()
    finally:
        picture.seek(0)
    what = "pages" if picture.format == "TIFF" else "frames"
    return (f"{called} has several {what}: only the first is used",)


_SEVERAL = ("GIF", "WEBP", "PNG", "TIFF", "AVIF")
_BOUNDS = (
    f"at most {MAX_PICTURE_PIXELS / 1e6:.0f} million pixels (such as 8192 x 8192 or 1600 x 30000) and at most"
    f" {MAX_PICTURE_SIDE} px on a side"
)


def check_size(path: StrPath, size: tuple[int, int], name: str = "picture") -> None:
    """Raise unless a picture of a size [px] may be decoded.

    Raises:
        InvalidInputError: it has too many pixels, or too long a side.
    """
    if max(size) > MAX_PICTURE_SIDE or size[0] * size[1] > MAX_PICTURE_PIXELS:
        raise InvalidInputError(f"{name} {path} must be {_BOUNDS}. Got: {size[0]} x {size[1]} px")


def _reason(error: Exception) -> str:
    text = str(error)
    return (
        text if isinstance(error, OSError | SyntaxError | ValueError) and text else f"it is damaged ({text or 'cut'})"
    )
