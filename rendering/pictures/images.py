"""Pictures and masks from files and into files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.limits import MAX_PICTURE_SIDE
from ..files import replacing
from .picture_files import reading
from .picture_modes import has_transparency, in_8_bits, in_srgb, with_opacity
from .pixels import as_uint8

__all__ = ["LONGEST_SIDE", "check_image_output", "data_address", "load_image", "load_mask", "save_image"]

LONGEST_SIDE = MAX_PICTURE_SIDE
"""The longest side of a picture that is accepted [px]; ``MAX_PICTURE_PIXELS`` bounds its area."""

StrPath = str | os.PathLike[str]

_COMPRESSION = 4  # of PNG: within 2 % of the size at Pillow's own 6, in less than half the time


def load_image(path: StrPath, *, alpha: bool = False) -> NDArray[np.uint8]:
    """Read an illustration.

    The orientation noted by a camera or scanner is applied, an embedded colour profile is converted to sRGB,
    pictures of 16 and 32 bits a channel and grey ones become 8-bit RGB, and transparent areas are laid over white
    unless alpha is kept. Of an animated file the first frame is read.

    Args:
        path: a PNG, JPEG, WebP, TIFF, PSD or other picture that Pillow reads without help of another program.
        alpha: keep the alpha of a picture that is not opaque everywhere.

    Returns:
        RGB, uint8, shape [h, w, 3]; or straight RGBA, shape [h, w, 4], black where alpha is 0.

    Raises:
        InvalidInputError: there is no such file, it is no picture, it is damaged or it is too large.

    Examples:
        >>> import tempfile
        >>> from pathlib import Path
        >>> import numpy as np
        >>> from physanimator.rendering.pictures import load_image, save_image
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     save_image(Path(folder, "red.png"), np.full((4, 6, 3), (255, 0, 0), np.uint8))
        ...     picture = load_image(Path(folder, "red.png"))
        >>> picture.shape, picture[0, 0].tolist()
        ((4, 6, 3), [255, 0, 0])
    """
    from PIL import Image, ImageOps

    with reading(path, "picture") as opened:
        picture = in_srgb(ImageOps.exif_transpose(opened), name=f"picture {path}")
        if has_transparency(picture):
            picture = with_opacity(picture, name=f"picture {path}")
            pixels = np.array(picture)
            if alpha and pixels[..., 3].min() < 255:
                pixels[pixels[..., 3] == 0] = 0
                return pixels
            picture = Image.alpha_composite(Image.new("RGBA", picture.size, "white"), picture)
        return np.array(in_8_bits(picture, name=f"picture {path}").convert("RGB"))


def load_mask(path: StrPath, *, width: int, height: int) -> NDArray[np.float32]:
    """Read a mask: where a moving part is.

    White counts where there is white on black; where the colours do not decide, the opacity does, so that a cut-out
    part serves as its own mask. One colour on black or white counts where that colour is. See
    :func:`~physanimator.rendering.pictures.mask_files.read_mask` for the whole rule, and for what it remarks on a mask.

    Args:
        path: a picture file of any mode.
        width: width of the illustration [px].
        height: height of the illustration [px].

    Returns:
        Coverage from 0 to 1, float32, shape [h, w]; a mask of the illustration's proportions is scaled to its size.

    Raises:
        InvalidInputError: the file cannot be read, has other proportions than the illustration, is empty, or shows
            several parts.

    Examples:
        >>> import tempfile
        >>> from pathlib import Path
        >>> import numpy as np
        >>> from physanimator.rendering.pictures import load_mask, save_image
        >>> drawn = np.zeros((6, 8, 3), np.uint8)
        >>> drawn[2:5, 2:6] = 255
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     save_image(Path(folder, "mask.png"), drawn)
        ...     mask = load_mask(Path(folder, "mask.png"), width=8, height=6)
        >>> mask.shape, float(mask.sum())
        ((6, 8), 12.0)
    """
    from .mask_files import read_mask

    return read_mask(path, width=width, height=height).coverage


def save_image(path: StrPath, image: NDArray[Any]) -> None:
    """Write a picture; its suffix names the format. An earlier file is replaced only by a complete one.

    Args:
        path: where to; the folder must exist.
        image: grey, RGB or RGBA, uint8 or 0..1 float, shape [h, w], [h, w, 3] or [h, w, 4].

    Raises:
        InvalidInputError: see :func:`check_image_output`; or the format does not hold so large a picture.

    Examples:
        >>> import tempfile
        >>> from pathlib import Path
        >>> import numpy as np
        >>> from physanimator.rendering.pictures import save_image
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     save_image(Path(folder, "grey.png"), np.full((4, 6, 3), 0.5))
        ...     Path(folder, "grey.png").exists()
        True
    """
    from PIL import Image

    from .picture_formats import check_picture_format

    pixels = as_uint8(np.asarray(image))
    if pixels.ndim not in (2, 3) or pixels.shape[2:] not in ((), (3,), (4,)) or pixels.size == 0:
        raise InvalidInputError(f"a picture must have shape [h, w], [h, w, 3] or [h, w, 4]. Got: {pixels.shape}")
    picture = Image.fromarray(pixels)
    kind = check_picture_format(path, mode=picture.mode, size=picture.size)
    with replacing(path) as temporary:
        picture.save(temporary, format=kind, compress_level=_COMPRESSION)


def check_image_output(path: StrPath, *, alpha: bool = False) -> Path:
    """Refuse a place that :func:`save_image` could not write to, before any long work.

    Args:
        path: where the picture is to be.
        alpha: whether the picture will have an alpha channel.

    Returns:
        The same place.

    Raises:
        InvalidInputError: the suffix is not that of a picture that can be written, or nothing can be written there; see
            :func:`~physanimator.rendering.files.check_file_place`.
    """
    from ..files import check_file_place
    from .picture_formats import check_picture_format

    check_picture_format(path, mode="RGBA" if alpha else "RGB")
    check_file_place(path)
    return Path(path)


def data_address(image: NDArray[Any]) -> str:
    """A picture as a ``data:`` address, to be part of an SVG or a web page.

    Args:
        image: RGB, uint8 or 0..1 float, shape [h, w, 3].
    """
    import base64
    import io

    from PIL import Image

    file = io.BytesIO()
    Image.fromarray(as_uint8(image)).save(file, format="JPEG", quality=88)
    return "data:image/jpeg;base64," + base64.b64encode(file.getvalue()).decode("ascii")
