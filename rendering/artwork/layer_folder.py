"""A folder of PNG files as layers: by their names, or by a list that See-through writes beside them."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any

from ...physics.errors import InvalidInputError, counted, require, shown
from ..files import check_regular
from .artwork import ArtLayer, Artwork
from .limits import MAX_OFFSET, MemoryCount, check_canvas
from .png_layers import as_one_dtype, picture_of, trimmed
from .reading import reading

__all__ = ["is_layer_list", "read_layer_folder", "read_layer_list"]

StrPath = str | os.PathLike[str]

_LIST = "layers.json"
_MOST_TEXT = 2**24


def is_layer_list(path: StrPath) -> bool:
    """Whether a name is that of a list of layers, as See-through calls it."""
    return Path(path).name.lower().endswith(_LIST)


def read_layer_folder(folder: StrPath) -> Artwork:
    """Read a folder of layers.

    Where there is a list of layers, it says what is a layer and where it lies. Otherwise every PNG file is one, all of
    one size, from back to front in the order of their names, numbers in them by their value.

    Raises:
        InvalidInputError: there are no layers, or one cannot be read.
    """
    name = f"artwork {os.fspath(folder)}"
    with reading(folder, name):
        inside = [path for path in Path(folder).iterdir() if not path.name.startswith(".")]
        lists = sorted(path for path in inside if is_layer_list(path))
        if len(lists) == 1:
            return read_layer_list(lists[0])
        if lists:
            raise InvalidInputError(f"{name} must hold one list of layers; give that. Got: {len(lists)} of them")
        files = sorted((path for path in inside if path.suffix.lower() == ".png"), key=_natural)
        if not files:
            raise InvalidInputError(f"{name} must hold PNG files, one a layer. Got: none")
        return _in_order(files, name)


def _natural(path: Path) -> tuple[Any, ...]:
    """Numbers in names by their value: 2 before 10."""
    parts = re.split(r"(\d+)", path.stem.casefold())
    return tuple((int(part[:18]), "") if part.isdigit() and part.isascii() else (-1, part) for part in parts)


def _unnumbered(name: str) -> str:
    """The name of a layer without the number that puts its file in order: ``03 hair`` is hair."""
    return re.sub(r"^\d+[\s_.\-]+", "", name) or name


def _in_order(files: list[Path], name: str) -> Artwork:
    count = MemoryCount(name)
    layers: list[ArtLayer] = []
    remarks: list[str] = []
    size: tuple[int, int] | None = None
    for path in files:
        with _opened(path) as file:
            pixels = picture_of(file, f"layer {path}", remarks)
        size = size or (pixels.shape[1], pixels.shape[0])
        if size != (pixels.shape[1], pixels.shape[0]):
            raise InvalidInputError(
                f"layer {path} must be as large as {files[0].name}, {size[0]} x {size[1]} px."
                f" Got: {pixels.shape[1]} x {pixels.shape[0]} px"
            )
        layer = trimmed(ArtLayer(_unnumbered(path.stem), pixels))
        count.add(layer.pixels.nbytes)
        layers.append(layer)
    assert size is not None
    return Artwork(*size, as_one_dtype(layers), tuple(remarks))


def _opened(path: Path) -> Any:
    check_regular(path, "layer")
    return path.open("rb")


def read_layer_list(path: StrPath) -> Artwork:
    """Read what a list of See-through's names: ``{"width", "height", "layers": [{"name", "filename", ...}]}``.

    A layer with a larger ``depth_median`` is farther back; where one has none, the list is from back to front.

    Raises:
        InvalidInputError: the list is none, or a layer cannot be read.
    """
    name = f"artwork {os.fspath(path)}"
    with reading(path, name):
        with _opened(Path(path)) as file:
            text = file.read(_MOST_TEXT + 1)
        require(name, counted(len(text), "byte"), len(text) <= _MOST_TEXT, f"at most {_MOST_TEXT / 2**20:.0f} MiB")
        document = json.loads(text.decode("utf-8-sig"))
        if not isinstance(document, dict) or not isinstance(document.get("layers"), list):
            raise InvalidInputError(
                f"{name} must be a list of layers, as See-through writes it. Got: {shown(document)}"
            )
        width, height = (_whole(document.get(key), f"{name}: {key}") for key in ("width", "height"))
        check_canvas(width, height, name)
        count = MemoryCount(name)
        layers: list[ArtLayer] = []
        remarks: list[str] = []
        for entry in document["layers"]:
            layer = _listed(entry, Path(path).parent, name, remarks)
            count.add(layer.pixels.nbytes)
            layers.append(layer)
        if all(layer.depth is not None for layer in layers):
            layers.sort(key=lambda layer: -(layer.depth or 0.0))
        return Artwork(width, height, as_one_dtype(layers), tuple(remarks))


def _listed(entry: Any, folder: Path, name: str, remarks: list[str]) -> ArtLayer:
    if not isinstance(entry, dict) or not isinstance(entry.get("filename"), str):
        raise InvalidInputError(f"{name}: each layer must name its file. Got: {shown(entry)}")
    file_name = entry["filename"]
    if not _is_plain(file_name):
        raise InvalidInputError(f"{name}: filename must be that of a file beside the list. Got: {shown(file_name)}")
    called = entry.get("name") or Path(file_name).stem
    with _opened(folder / file_name) as file:
        pixels = picture_of(file, f"layer {folder / file_name}", remarks)
    depth = entry.get("depth_median")
    if depth is not None and (isinstance(depth, bool) or not isinstance(depth, int | float) or not abs(depth) < 1e9):
        raise InvalidInputError(f"{name}: depth_median must be a number. Got: {shown(depth)}")
    left, top = (_whole(entry.get(key, 0), f"{name}: {key}") for key in ("left", "top"))
    return trimmed(ArtLayer(str(called), pixels, left=left, top=top, depth=None if depth is None else float(depth)))


def _is_plain(name: str) -> bool:
    """Whether a name is that of a file in the same folder, on any system."""
    return bool(name) and name not in (".", "..") and not any(each in name for each in "/\\:\0")


def _whole(value: Any, name: str) -> int:
    right = isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= MAX_OFFSET
    require(name, value, right, f"a number of at most {MAX_OFFSET}")
    return round(value)
