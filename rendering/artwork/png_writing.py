"""Artwork as a folder of PNG files, one a layer."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ..files import check_folder_place, plain_name, replacing
from .artwork import ArtLayer, Artwork
from .flattening import as_whole_numbers

__all__ = ["check_layer_folder", "layer_on_canvas", "png_names", "save_layer_pngs"]

StrPath = str | os.PathLike[str]


def save_layer_pngs(artwork: Artwork, folder: StrPath) -> list[Path]:
    """Write each layer as a PNG file of the canvas' size, named from back to front: ``00 paper.png``, ``01 hair.png``.

    What lies beyond the canvas is cut off. A layer's opacity is in its pixels; blend modes are lost.

    Args:
        artwork: 8 or 16 bits a channel.
        folder: where to, without PNG files; it is made where it is missing.

    Returns:
        The files.

    Raises:
        InvalidInputError: see :func:`check_layer_folder`.
    """
    check_layer_folder(folder)
    place = Path(folder)
    place.mkdir(exist_ok=True)
    paths = []
    for name, layer in zip(png_names(artwork), artwork.layers, strict=True):
        data = _encoded(layer_on_canvas(layer, artwork))
        with replacing(place / name) as temporary:
            temporary.write_bytes(data)
        paths.append(place / name)
    return paths


def check_layer_folder(folder: StrPath) -> None:
    """Refuse a folder that :func:`save_layer_pngs` could not fill: other PNG files in it would be mixed up with them.

    Raises:
        InvalidInputError: nothing can be written there, or PNG files are there.
    """
    place = check_folder_place(folder)
    there = sorted(path.name for path in place.iterdir() if path.suffix.lower() == ".png") if place.is_dir() else []
    if there:
        raise InvalidInputError(f"folder {folder} must hold no PNG files yet. Got: {there[0]}")


def png_names(artwork: Artwork) -> list[str]:
    """A file name for each layer, which any system can write."""
    digits = max(2, len(str(len(artwork.layers) - 1)))
    return [f"{index:0{digits}} {plain_name(name, or_else='layer')}.png" for index, name in enumerate(artwork.names)]


def layer_on_canvas(layer: ArtLayer, artwork: Artwork) -> NDArray[Any]:
    """A layer alone as large as the canvas, with its opacity: straight RGBA, shape [height, width, 4]."""
    result = np.zeros((artwork.height, artwork.width, 4), artwork.dtype)
    left, top, right, bottom = layer.box
    x0, x1, y0, y1 = max(left, 0), min(right, artwork.width), max(top, 0), min(bottom, artwork.height)
    if x0 < x1 and y0 < y1:
        result[y0:y1, x0:x1] = layer.pixels[y0 - top : y1 - top, x0 - left : x1 - left]
    if layer.opacity != 1:
        alpha = result[..., 3].astype(np.float32) * np.float32(layer.opacity / np.iinfo(artwork.dtype).max)
        result[..., 3] = as_whole_numbers(alpha, artwork.dtype)
    return result


def _encoded(pixels: NDArray[Any]) -> bytes:
    written, data = cv2.imencode(".png", cv2.cvtColor(pixels, cv2.COLOR_RGBA2BGRA))
    if not written:
        raise InvalidInputError(f"a layer of {pixels.shape[1]} x {pixels.shape[0]} px cannot be written as PNG")
    return bytes(data)
