"""Pictures of the host's folders: listed, found, and read as the host's own Load Image reads them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...physics.errors import InvalidInputError, require

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["as_load_image", "picture_files", "picture_place"]

_ENDINGS = (".png", ".jpg", ".jpeg", ".webp", ".bmp", ".gif", ".tif", ".tiff", ".avif")
_FOLDERS = ("input", "output", "temp")
_MOST = 10_000


def picture_files() -> list[str]:
    """Pictures that lie in the input folder itself, as the host's own Load Image lists them."""
    root = _folder("input")
    try:
        found = [entry.name for entry in os.scandir(root) if entry.name.lower().endswith(_ENDINGS) and entry.is_file()]
    except OSError:
        return []
    return sorted(found)[:_MOST]


def picture_place(name: str) -> Path:
    """Where a picture is.

    Args:
        name: a path in the input folder; with `` [output]`` or `` [temp]`` behind it, in one of those.

    Raises:
        InvalidInputError: it leads out of its folder, or there is no such file.
    """
    bare, kind = name, "input"
    for folder in _FOLDERS:
        if name.endswith(f" [{folder}]"):
            bare, kind = name.removesuffix(f" [{folder}]"), folder
    root = _folder(kind)
    place = Path(os.path.abspath(root / bare.replace("\\", "/"))) if "\0" not in bare else root
    if root not in place.parents or not place.is_file():
        raise InvalidInputError(f"picture must be a file of the host's {kind} folder. Got: {name[:60]!r}")
    return place


def as_load_image(place: Path, *, most_pixels: int | None = None) -> NDArray[np.uint8]:
    """A picture with the very colours that the host's Load Image gives: RGB, shape [h, w, 3].

    Args:
        place: of the file.
        most_pixels: what it may have; None for any number that Pillow opens.

    Raises:
        InvalidInputError: it is no picture, or a larger one.
    """
    from PIL import Image, ImageOps

    try:
        with Image.open(place) as opened:
            _require_small(opened, most_pixels)
            picture = ImageOps.exif_transpose(opened)
            if picture.mode == "I":
                picture = picture.point(lambda level: level * (1 / 255))
            return np.array(picture.convert("RGB"))
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise InvalidInputError(f"picture must be a file that can be read. Got: {place.name[:60]!r}") from error


def _require_small(opened: Any, most: int | None) -> None:
    width, height = opened.size
    if most is not None:
        fits = width * height <= most
        require("picture", f"{width} x {height} px", fits, f"of at most {most:,} pixels to be cut while you click")


def _folder(kind: str) -> Path:
    import folder_paths

    return Path(os.path.abspath(getattr(folder_paths, f"get_{kind}_directory")()))
