"""Layered files of any kind."""

from __future__ import annotations

import os
from pathlib import Path

from ...physics.errors import InvalidInputError
from .artwork import Artwork
from .layer_folder import is_layer_list, read_layer_folder, read_layer_list
from .openraster import read_openraster
from .psd import read_psd

__all__ = ["is_artwork_file", "load_artwork"]

StrPath = str | os.PathLike[str]

_READERS = {".psd": read_psd, ".psb": read_psd, ".ora": read_openraster}


def is_artwork_file(path: StrPath) -> bool:
    """Whether a path is a layered file by its name, or a folder.

    A PSD file without layers is one as well; it has one layer.

    Examples:
        >>> from physanimator.rendering.artwork import is_artwork_file
        >>> is_artwork_file("girl.psd"), is_artwork_file("girl.png")
        (True, False)
    """
    return Path(path).suffix.lower() in _READERS or is_layer_list(path) or os.path.isdir(path)


def load_artwork(path: StrPath, *, groups: bool = False) -> Artwork:
    """Read a layered file.

    Args:
        path: a .psd, .psb or .ora file; a folder of PNG files of one size, from back to front by their names; or a
            folder with a ``layers.json`` of See-through's, or that list itself.
        groups: make one layer of each outermost group; otherwise every layer is one, whatever group it is in.

    Returns:
        Its layers from back to front, hidden ones included; ``warnings`` tells what is shown otherwise than in the
        program that wrote it.

    Raises:
        InvalidInputError: there is no such file, it is damaged or too large, or of another kind.

    Examples:
        >>> import tempfile
        >>> from pathlib import Path
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import load_artwork
        >>> from physanimator.rendering.pictures import save_image
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     for name in ("1 sky", "2 hair"):
        ...         save_image(Path(folder, name + ".png"), np.full((4, 6, 3), 200, np.uint8))
        ...     artwork = load_artwork(folder)
        >>> artwork.names
        ('sky', 'hair')
    """
    if Path(path).is_dir():
        return read_layer_folder(path)
    if is_layer_list(path):
        return read_layer_list(path)
    reader = _READERS.get(Path(path).suffix.lower())
    if reader is None:
        raise InvalidInputError(
            f"artwork must be a {', '.join(_READERS)} file, a folder of PNG files or a list of layers. Got: {path}"
        )
    return reader(path, groups=groups)
