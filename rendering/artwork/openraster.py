"""OpenRaster files (.ora), which Krita, MyPaint and GIMP write.

Source: https://www.openraster.org, the baseline specification: a zip archive with ``stack.xml``, which lists layers and
stacks of layers, the top one first, and PNG files.
"""

from __future__ import annotations

import os
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import PurePosixPath
from typing import IO, cast
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from ...physics.errors import InvalidInputError
from ...physics.limits import MAX_LAYERS
from .artwork import ArtLayer, Artwork, Blend
from .groups import carried_down, merged
from .limits import MAX_OFFSET, MemoryCount, check_canvas
from .png_layers import as_one_dtype, picture_of, trimmed
from .reading import reading

__all__ = ["read_openraster"]

StrPath = str | os.PathLike[str]

_MOST_TEXT = 2**22
_DEEPEST = 64

_BLENDS: dict[str, Blend] = {
    "svg:src-over": "normal",
    "svg:multiply": "multiply",
    "svg:screen": "screen",
    "svg:overlay": "overlay",
    "svg:plus": "add",
    "svg:add": "add",
    "krita:add": "add",
    "krita:linear_dodge": "add",
}


def read_openraster(path: StrPath, *, groups: bool = False) -> Artwork:
    """Read the layers of an OpenRaster file.

    Stacks of layers become their layers, with the stack's place, opacity and visibility.

    Args:
        path: of the file.
        groups: make one layer of each outermost stack.

    Raises:
        InvalidInputError: there is no such file, it is no OpenRaster file, it is damaged, or too large.
    """
    name = f"artwork {os.fspath(path)}"
    with reading(path, name), _archive(path) as archive:
        image = _stack_xml(archive, name)
        width, height = (_whole(image, key, name) for key in ("w", "h"))
        check_canvas(width, height, name)
        reader = _Reader(archive, name, groups=groups)
        layers = [layer for child in image if child.tag == "stack" for layer in reader.stack(child, 0, 0, 0)]
        return Artwork(width, height, as_one_dtype(layers), tuple(reader.remarks))


def _archive(path: StrPath) -> zipfile.ZipFile:
    with open(path, "rb") as file:
        if file.read(2) != b"PK":
            raise InvalidInputError(
                f"artwork must be an OpenRaster file, which is a zip archive. Got: {path}, which is none"
            )
    return zipfile.ZipFile(path)


class _Reader:
    """Reads the layers of one archive.

    Attributes:
        remarks: a sentence for each thing that is shown otherwise than in its own program.
    """

    def __init__(self, archive: zipfile.ZipFile, name: str, *, groups: bool) -> None:
        self.remarks: list[str] = []
        self._archive = archive
        self._name = name
        self._groups = groups
        self._memory = MemoryCount(name)

    def stack(self, stack: Element, left: int, top: int, depth: int) -> list[ArtLayer]:
        """The layers of a stack from back to front; the file names the top one first."""
        left, top = left + self._whole(stack, "x"), top + self._whole(stack, "y")
        layers: list[ArtLayer] = []
        for child in reversed(stack):
            if child.tag == "stack":
                layers += self._group(child, left, top, depth + 1)
            elif child.tag == "layer":
                layers.append(self._layer(child, left, top))
            else:
                self.remarks.append(f"layer {child.get('name', child.tag)} ({child.tag}) is left out: it has no pixels")
        return layers

    def _group(self, stack: Element, left: int, top: int, depth: int) -> list[ArtLayer]:
        inner, name = self.stack(stack, left, top, depth), stack.get("name", "stack")
        opacity, blend = self._opacity(stack), self._blend(stack)
        visible = stack.get("visibility") != "hidden"
        drawn = [layer for layer in as_one_dtype(inner) if layer.visible]
        if self._groups and depth == 1 and drawn:
            return [replace(merged(drawn, name=name, opacity=opacity, blend=blend), visible=visible)]
        layers, lost = carried_down(inner, name=name, opacity=opacity, blend=blend, visible=visible)
        self.remarks += lost
        return layers

    def _layer(self, element: Element, left: int, top: int) -> ArtLayer:
        name = element.get("name") or PurePosixPath(element.get("src", "layer")).stem
        with self._opened(element.get("src", ""), name) as file:
            pixels = picture_of(cast("IO[bytes]", file), f"{self._name}: layer {name}", self.remarks)
        layer = ArtLayer(
            name=name,
            pixels=pixels,
            left=left + self._whole(element, "x"),
            top=top + self._whole(element, "y"),
            opacity=self._opacity(element),
            blend=self._blend(element),
            visible=element.get("visibility") != "hidden",
        )
        layer = trimmed(layer)
        self._memory.add(layer.pixels.nbytes)
        return layer

    @contextmanager
    def _opened(self, source: str, name: str) -> Iterator[zipfile.ZipExtFile]:
        """The picture that a layer names: always one in the archive, whatever its path looks like."""
        try:
            with self._archive.open(source) as file:
                yield cast("zipfile.ZipExtFile", file)
        except KeyError:
            raise InvalidInputError(
                f"{self._name}: layer {name} must name a picture in the file. Got: {source}"
            ) from None

    def _opacity(self, element: Element) -> float:
        return min(max(self._number(element, "opacity", 1.0), 0.0), 1.0)

    def _blend(self, element: Element) -> Blend:
        mode = element.get("composite-op", "svg:src-over")
        if mode not in _BLENDS:
            name = element.get("name", element.tag)
            self.remarks.append(f"layer {name}: blend mode {mode.split(':')[-1]} is drawn as normal")
        return _BLENDS.get(mode, "normal")

    def _whole(self, element: Element, key: str) -> int:
        number = self._number(element, key, 0.0)
        if abs(number) > MAX_OFFSET:
            raise InvalidInputError(
                f"{self._name}: {key} of a layer must be at most {MAX_OFFSET}. Got: {element.get(key)}"
            )
        return round(number)

    def _number(self, element: Element, key: str, usual: float) -> float:
        return _number(element, key, self._name, usual)


def _number(element: Element, key: str, name: str, usual: float | None = None) -> float:
    text = element.get(key)
    if text is None and usual is not None:
        return usual
    try:
        number = float(text or "")
    except ValueError:
        number = float("nan")
    if not abs(number) < float("inf"):
        raise InvalidInputError(f"{name}: {key} in stack.xml must be a number. Got: {text}")
    return number


def _whole(element: Element, key: str, name: str) -> int:
    return int(_number(element, key, name))


def _stack_xml(archive: zipfile.ZipFile, name: str) -> Element:
    """The list of layers."""
    try:
        with archive.open("stack.xml") as file:
            text = file.read(_MOST_TEXT + 1)
    except KeyError:
        raise InvalidInputError(f"{name} must hold a stack.xml, as OpenRaster files do. Got: none") from None
    if len(text) > _MOST_TEXT:
        raise InvalidInputError(f"{name}: stack.xml must have at most {_MOST_TEXT / 2**20:.0f} MiB. Got: more")
    image = _parsed(text, name)
    if image.tag != "image":
        raise InvalidInputError(f"{name}: stack.xml must describe an image. Got: {image.tag}")
    return image


def _parsed(text: bytes, name: str) -> Element:
    """XML without definitions of its own, which may grow without bound, and without endless depth."""
    builder, parser, depth = TreeBuilder(), expat.ParserCreate(), 0
    count = 0

    def begin(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > _DEEPEST or count > 4 * MAX_LAYERS:
            raise InvalidInputError(
                f"{name}: stack.xml must have at most {_DEEPEST} stacks in stacks and {MAX_LAYERS} layers. Got: more"
            )
        builder.start(tag, attributes)

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(tag)

    def refuse(*_: object) -> None:
        raise InvalidInputError(f"{name}: stack.xml must have no document type. Got: one")

    parser.StartElementHandler, parser.EndElementHandler = begin, end
    parser.StartDoctypeDeclHandler = refuse
    parser.Parse(text, True)
    return builder.close()
