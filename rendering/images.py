"""Pictures and masks from files and into files."""

from __future__ import annotations

import io
import os
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..physics.errors import InvalidInputError
from .atomic import replacing

if TYPE_CHECKING:
    from PIL import Image

__all__ = ["LONGEST_SIDE", "check_image_output", "data_address", "load_image", "load_mask", "save_image", "to_uint8"]

LONGEST_SIDE = 8192
"""The longest side of a picture that is accepted [px]."""

StrPath = str | os.PathLike[str]

_COMPRESSION = 4  # of PNG: within 2 % of the size at Pillow's own 6, in less than half the time


def load_image(path: StrPath, *, alpha: bool = False) -> NDArray[np.uint8]:
    """Read an illustration.

    The orientation noted by a camera or scanner is applied, an embedded colour profile is converted to sRGB,
    16-bit and grey pictures become 8-bit RGB, and transparent areas are laid over white unless alpha is kept. Of an
    animated file the first frame is read.

    Args:
        path: a PNG, JPEG, WebP or any other file that Pillow reads.
        alpha: keep the alpha of a picture that is not opaque everywhere.

    Returns:
        RGB, uint8, shape [h, w, 3]; or straight RGBA, shape [h, w, 4], black where alpha is 0.

    Raises:
        InvalidInputError: there is no such file, it is no picture, or it is too large.
    """
    from PIL import Image

    picture = _in_srgb(_open(path))
    if _has_transparency(picture):
        picture = _with_opacity(picture)
        pixels = np.array(picture)
        if alpha and pixels[..., 3].min() < 255:
            pixels[pixels[..., 3] == 0] = 0
            return pixels
        picture = Image.alpha_composite(Image.new("RGBA", picture.size, "white"), picture)
    return np.array(_in_8_bits(picture).convert("RGB"))


def load_mask(path: StrPath, *, width: int, height: int) -> NDArray[np.float32]:
    """Read a mask: where a moving part is.

    A picture with transparent areas counts by its opacity, so that a cut-out part serves as its own mask; any
    other picture counts by its brightness, white being inside.

    Args:
        path: a picture file of any mode.
        width: width of the illustration [px].
        height: height of the illustration [px].

    Returns:
        Coverage from 0 to 1, float32, shape [h, w].

    Raises:
        InvalidInputError: the file cannot be read, has another size than the illustration, or is empty.
    """
    picture = _open(path)
    if picture.size != (width, height):
        raise InvalidInputError(
            f"mask {path} must have the size of the picture, {width} x {height} px."
            f" Got: {picture.size[0]} x {picture.size[1]} px"
        )
    grey = np.array(_in_8_bits(picture).convert("L"))
    if _has_transparency(picture):
        opacity = np.array(_with_opacity(picture))[..., 3]
        grey = opacity if opacity.min() < 255 else grey
    if grey.max() < 128:
        raise InvalidInputError(f"mask {path} must be white (or opaque) where the part is. Got: an empty mask")
    return grey.astype(np.float32) / np.float32(255)


def save_image(path: StrPath, image: NDArray[Any]) -> None:
    """Write a picture; its suffix names the format. An earlier file is replaced only by a complete one.

    Args:
        path: where to; the folder must exist.
        image: grey, RGB or RGBA, uint8 or 0..1 float, shape [h, w], [h, w, 3] or [h, w, 4].

    Raises:
        InvalidInputError: the suffix is not that of a picture, or the folder does not exist.
    """
    from PIL import Image

    target = check_image_output(path)
    with replacing(target) as temporary:
        Image.fromarray(to_uint8(image)).save(temporary, compress_level=_COMPRESSION)


def check_image_output(path: StrPath) -> Path:
    """Refuse a place that :func:`save_image` could not write to, before any long work.

    Args:
        path: where the picture is to be.

    Returns:
        The same place.

    Raises:
        InvalidInputError: the suffix is not that of a picture, or the folder does not exist.
    """
    from PIL import Image

    target = Path(path)
    if target.suffix.lower() not in Image.registered_extensions():
        raise InvalidInputError(f"a picture's name must end in .png, .jpg or .webp. Got: {path}")
    if not target.parent.is_dir():
        raise InvalidInputError(f"the folder for {path} must exist. Got: no folder {target.parent}")
    return target


def data_address(image: NDArray[Any]) -> str:
    """A picture as a ``data:`` address, to be part of an SVG or a web page.

    Args:
        image: RGB, uint8 or 0..1 float, shape [h, w, 3].
    """
    import base64
    import io

    from PIL import Image

    file = io.BytesIO()
    Image.fromarray(to_uint8(image)).save(file, format="JPEG", quality=88)
    return "data:image/jpeg;base64," + base64.b64encode(file.getvalue()).decode("ascii")


def to_uint8(image: NDArray[Any]) -> NDArray[np.uint8]:
    """Values 0..1 as 0..255, rounded; uint8 passes unchanged.

    Args:
        image: uint8 or float, any shape.
    """
    if image.dtype == np.uint8:
        return image
    return np.rint(np.clip(image, 0, 1) * 255).astype(np.uint8)


def _open(path: StrPath) -> Image.Image:
    """The first frame of a picture file, upright."""
    from PIL import Image, ImageOps, UnidentifiedImageError

    try:
        with warnings.catch_warnings():
            # Pillow warns below our own limit and refuses above it; _check_size says it in our words.
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            opened = Image.open(path)
        with opened as picture:
            _check_size(path, picture.size)
            return ImageOps.exif_transpose(picture)
    except FileNotFoundError:
        raise InvalidInputError(f"picture must be an existing file. Got: {path}") from None
    except Image.DecompressionBombError:
        raise InvalidInputError(f"picture {path} must be at most {LONGEST_SIDE} px on a side. Got: more") from None
    except UnidentifiedImageError:
        raise InvalidInputError(f"picture must be a PNG, JPEG or WebP file. Got: {path}") from None
    except InvalidInputError:
        raise
    except (OSError, SyntaxError, ValueError) as error:
        raise InvalidInputError(f"picture {path} cannot be read: {error}") from error


def _check_size(path: StrPath, size: tuple[int, int]) -> None:
    if max(size) > LONGEST_SIDE:
        raise InvalidInputError(
            f"picture {path} must be at most {LONGEST_SIDE} px on a side. Got: {size[0]} x {size[1]} px"
        )


def _has_transparency(picture: Image.Image) -> bool:
    return picture.mode in ("LA", "La", "PA", "RGBA", "RGBa") or "transparency" in picture.info


def _with_opacity(picture: Image.Image) -> Image.Image:
    """RGB and opacity of a picture that has transparency, 8 bits each."""
    from PIL import Image

    reduced = _in_8_bits(picture)
    if reduced is picture:
        return picture.convert("RGBA")
    # One of the 65536 greys means transparent; after the reduction others would be equal to it.
    opacity = np.where(np.array(picture) == picture.info["transparency"], 0, 255).astype(np.uint8)
    return Image.merge("RGBA", [*[reduced.convert("L")] * 3, Image.fromarray(opacity)])


def _in_8_bits(picture: Image.Image) -> Image.Image:
    """The picture with 16-bit or float grey values brought to 0..255 (Pillow would clip them)."""
    from PIL import Image

    if picture.mode not in ("I", "F", "I;16", "I;16L", "I;16B", "I;16N"):
        return picture
    values = np.array(picture).astype(np.float64)
    brightest = 65535.0 if picture.mode != "F" else max(float(values.max()), 1.0)
    return Image.fromarray(to_uint8(values / brightest))


def _in_srgb(picture: Image.Image) -> Image.Image:
    """The picture's colours as sRGB values; drawing tablets embed wider profiles such as Display P3."""
    from PIL import ImageCms

    profile = picture.info.get("icc_profile")
    if not profile or picture.mode not in ("RGB", "RGBA", "CMYK"):
        return picture
    try:
        source = ImageCms.ImageCmsProfile(io.BytesIO(profile))
        if "srgb" in ImageCms.getProfileDescription(source).lower():
            return picture
        mode = "RGBA" if picture.mode == "RGBA" else "RGB"
        converted = ImageCms.profileToProfile(picture, source, ImageCms.createProfile("sRGB"), outputMode=mode)
    except (ImageCms.PyCMSError, OSError):
        return picture
    return picture if converted is None else converted
