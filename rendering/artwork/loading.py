"""Layered files of any kind."""

from __future__ import annotations

import os
from pathlib import Path

from ...physics.errors import InvalidInputError
from .artwork import Artwork
from .psd import read_psd

__all__ = ["is_artwork_file", "load_artwork"]

StrPath = str | os.PathLike[str]

_READERS = {".psd": read_psd, ".psb": read_psd}


def is_artwork_file(path: StrPath) -> bool:
    """Whether a name is that of a layered file, or a folder is there."""
    return Path(path).suffix.lower() in _READERS or os.path.isdir(path)


def load_artwork(path: StrPath) -> Artwork:
    """Read a layered file.

    Args:
        path: a .psd or .psb file.

    Returns:
        Its layers from back to front, hidden ones included.

    Raises:
        InvalidInputError: there is no such file, it is damaged or too large, or of another kind.
    """
    reader = _READERS.get(Path(path).suffix.lower())
    if reader is None:
        raise InvalidInputError(f"artwork must be a {', '.join(_READERS)} file. Got: {path}")
    return reader(path)
