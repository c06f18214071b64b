"""Photoshop's PSD and PSB files, which Clip Studio Paint, Krita, SAI, GIMP and Live2D's artists write as well."""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator
from typing import TYPE_CHECKING

from ...physics.errors import InvalidInputError
from .artwork import ArtLayer, Artwork
from .limits import MAX_OFFSET, check_canvas, check_layer_sizes
from .psd_colours import in_srgb_colours
from .reading import reading

if TYPE_CHECKING:
    from psd_tools import PSDImage

__all__ = ["read_psd"]

StrPath = str | os.PathLike[str]

_MOST_OBJECTS = 2_000_000
"""Things in a file's descriptions that are read, such as points of paths and glyphs of text."""


def read_psd(path: StrPath, *, groups: bool = False) -> Artwork:
    """Read the layers of a PSD or PSB file.

    Groups become their layers, with the group's opacity, mask and visibility; masks are applied; clipping layers
    become part of what they are clipped to. Hidden layers are kept as hidden.

    Args:
        path: of the file: RGB or greyscale, 8 or 16 bits a channel.
        groups: make one layer of each outermost group.

    Raises:
        InvalidInputError: there is no such file, it is no PSD, it is damaged, too large, or of another kind.
    """
    from .psd_layers import layers_of

    name = f"artwork {os.fspath(path)}"
    with reading(path, name):
        document = _opened(path)
        _check_kind(document, name)
        check_canvas(document.width, document.height, name)
        check_layer_sizes(_sizes(document), document.depth // 8, name)
        layers, remarks = layers_of(document, groups=groups)
        if not layers:
            layers = [_flat(document)]
            remarks.append("the file has no layers that can be read: its picture is taken as one")
        layers = in_srgb_colours(layers, document, remarks)
        return Artwork(document.width, document.height, tuple(layers), tuple(remarks))


def _opened(path: StrPath) -> PSDImage:
    from psd_tools import PSDImage
    from psd_tools.psd.parse_limits import ParseLimits

    with open(path, "rb") as file:
        if file.read(4) != b"8BPS":
            raise InvalidInputError(f"artwork must be a PSD file, which begins with 8BPS. Got: {path}, which does not")
    logging.getLogger("psd_tools").addHandler(logging.NullHandler())  # nobody but a host's log hears its remarks
    size = os.stat(path).st_size
    # What is read is in the file, so that it is at most a few times its size: nested structures are copied.
    limits = ParseLimits(
        max_read_bytes=size + 1, max_total_bytes=16 * size + 2**20, max_objects=_MOST_OBJECTS, max_nesting_depth=64
    )
    return PSDImage.open(path, parse_limits=limits)


def _check_kind(document: PSDImage, name: str) -> None:
    from psd_tools.constants import ColorMode

    mode = document.color_mode
    if mode not in (ColorMode.RGB, ColorMode.GRAYSCALE):
        raise InvalidInputError(
            f"{name} must be RGB or greyscale; convert it to RGB in the painting program (such as Image > Mode > RGB"
            f" Color) and save it again. Got: {'CMYK' if mode == ColorMode.CMYK else mode.name.capitalize()}"
        )
    if document.depth not in (8, 16):
        raise InvalidInputError(
            f"{name} must have 8 or 16 bits a channel; convert it in the painting program and save it again. Got:"
            f" {document.depth} bits"
        )


def _sizes(document: PSDImage) -> Iterator[tuple[str, int, int]]:
    """Of the pixels that would be decoded."""
    from .psd_layers import all_layers, name_of
    from .psd_pixels import COLOURED

    for layer in all_layers(document):
        if layer.kind in COLOURED and not layer.has_pixels():
            yield name_of(layer), document.width, document.height
        elif not layer.is_group():
            _check_offset(layer.left, layer.top, name_of(layer))
            yield name_of(layer), layer.width, layer.height


def _check_offset(left: int, top: int, name: str) -> None:
    if max(abs(left), abs(top)) > MAX_OFFSET:
        raise InvalidInputError(f"layer {name} must lie within {MAX_OFFSET} px of the canvas. Got: {left}, {top}")


def _flat(document: PSDImage) -> ArtLayer:
    """A file without layers: its picture as one."""
    import numpy as np
    from psd_tools.constants import ColorMode

    dtype = np.dtype(f">u{document.depth // 8}")
    size = document.height, document.width
    planes = document._record.image_data.get_data(document._record.header, split=True)
    colours = 3 if document.color_mode == ColorMode.RGB else 1
    pixels = np.full((*size, 4), np.iinfo(dtype).max, dtype.newbyteorder("="))
    for index in range(3):
        pixels[..., index] = np.frombuffer(planes[min(index, colours - 1)], dtype).reshape(size)
    return ArtLayer("picture", pixels)
