"""Pictures of the host's folders: listed, found, and read as the host's own Load Image reads them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...physics.errors import InvalidInputError, require

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["as_load_image", "picture_files", "picture_place", "require_small"]

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
    try:
        found = root in place.parents and place.is_file()
    except OSError:  # a name longer than any file's
        found = False
    if not found:
        raise InvalidInputError(f"picture must be a file of the host's {kind} folder. Got: {name[:60]!r}")
    return place


def as_load_image(place: Path) -> NDArray[np.uint8]:
    """A picture with the very colours that the host's Load Image gives: RGB, shape [h, w, 3].

    Args:
        place: of the file.

    Raises:
        InvalidInputError: it is no picture.
    """
    from PIL import Image, ImageOps

    with _reading(place), Image.open(place) as opened:
        picture = ImageOps.exif_transpose(opened)
        if picture.mode == "I":
            picture = picture.point(lambda level: level * (1 / 255))
        return np.array(picture.convert("RGB"))


def require_small(place: Path, most: int) -> None:
    """Refuse a picture by what its file says of its size, before any of it is unpacked.

    Args:
        place: of the file.
        most: pixels that it may have.

    Raises:
        InvalidInputError: it is no picture, or has more.
    """
    from PIL import Image

    with _reading(place), Image.open(place) as opened:
        width, height = opened.size
    fits = width * height <= most
    expected = f"of at most {most:,} pixels to be cut while you click; run the node to cut a larger one"
    require("picture", f"{width} x {height} px", fits, expected)


@contextmanager
def _reading(place: Path) -> Iterator[None]:
    """Let an error tell which file cannot be read."""
    from PIL import Image

    try:
        yield
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise InvalidInputError(f"picture must be a file that can be read. Got: {place.name[:60]!r}") from error


def _folder(kind: str) -> Path:
    import folder_paths

    return Path(os.path.abspath(getattr(folder_paths, f"get_{kind}_directory")()))
