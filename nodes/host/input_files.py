"""Layered files of the host's input folder: listed, found, and told apart by their contents."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from pathlib import Path

from ...physics.errors import InvalidInputError

__all__ = ["contents_of", "layered_files", "place_of"]

_ENDINGS = (".psd", ".psb", ".ora")
_DEEPEST = 3
_MOST = 1000
_CHUNK = 1 << 20


def layered_files() -> list[str]:
    """Layered files in the input folder, and folders of pictures or with a list of layers, as paths in it."""
    return sorted(_found(_root(), 0))[:_MOST]


def place_of(name: str) -> Path:
    """Where a file or folder of the input folder is.

    Args:
        name: a path in the input folder, perhaps with `` [input]`` behind it as the host's own nodes write it.

    Raises:
        InvalidInputError: it leads out of the input folder, or there is nothing.
    """
    root, bare = _root(), name.removesuffix(" [input]").replace("\\", "/")
    place = Path(os.path.abspath(root / bare)) if "\0" not in bare else root
    if place == root or root not in place.parents:
        raise InvalidInputError(f"file must be a layered file in the host's input folder. Got: {name[:60]!r}")
    try:
        found = place.exists()
    except OSError:  # a name longer than any file's
        found = False
    if not found:
        raise InvalidInputError(f"file must be one of the layered files in the input folder. Got: {name[:60]!r}")
    return place


def contents_of(place: Path) -> str:
    """A hash of a file, or of the files in a folder with their names."""
    files = [place] if place.is_file() else sorted(each for each in place.iterdir() if each.is_file())
    found = hashlib.sha256()
    for file in files:
        found.update(f"{file.name}\0{file.stat().st_size}\0".encode("utf-8", "surrogateescape"))
        with file.open("rb") as opened:
            while part := opened.read(_CHUNK):
                found.update(part)
    return found.hexdigest()


def _root() -> Path:
    import folder_paths

    return Path(os.path.abspath(folder_paths.get_input_directory()))


def _found(folder: Path, depth: int) -> Iterator[str]:
    root = _root()
    try:
        entries = list(os.scandir(folder))
    except OSError:
        return
    for entry in entries:
        path = Path(entry.path)
        name = path.relative_to(root).as_posix()
        if entry.name.startswith("."):
            continue
        if path.suffix.lower() in _ENDINGS and entry.is_file():
            yield name
        elif entry.is_dir() and depth < _DEEPEST:
            if _holds_layers(path):
                yield name
            yield from _found(path, depth + 1)


def _holds_layers(folder: Path) -> bool:
    """Whether a folder has two pictures at least, or a list of layers."""
    try:
        names = [entry.name.lower() for entry in os.scandir(folder)]
    except OSError:
        return False
    return sum(name.endswith(".png") for name in names) > 1 or any(name.endswith("layers.json") for name in names)
