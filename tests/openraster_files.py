"""OpenRaster files as Krita lays them out, made by hand."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
from physanimator.rendering.artwork import Artwork
from PIL import Image

MODES = {
    "normal": "svg:src-over",
    "multiply": "svg:multiply",
    "screen": "svg:screen",
    "overlay": "svg:overlay",
    "add": "svg:plus",
}


def png(pixels: np.ndarray) -> bytes:
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "PNG")
    return file.getvalue()


def write(path: Path, xml: str, **pictures: bytes) -> Path:
    """An archive with a given list of layers and ``data/NAME.png`` for each picture."""
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mimetype", "image/openraster", zipfile.ZIP_STORED)
        archive.writestr("stack.xml", xml)
        for name, data in pictures.items():
            archive.writestr(f"data/{name}.png", data)
    return path


def write_artwork(artwork: Artwork, path: Path) -> Path:
    """All layers of an artwork; empty ones cannot be pictures and are left out."""
    lines, pictures = [], {}
    for index, layer in enumerate(artwork.layers):
        if not layer.pixels.size:
            continue
        pictures[f"layer{index}"] = png(layer.pixels)
        seen = "visible" if layer.visible else "hidden"
        lines.insert(
            0,
            f'<layer src="data/layer{index}.png" x="{layer.left}" y="{layer.top}" name={quoteattr(layer.name)}'
            f' opacity="{layer.opacity:.17g}" visibility="{seen}" composite-op="{MODES[layer.blend]}"/>',
        )
    stack = f'<stack opacity="1" name="root" isolation="isolate">{"".join(lines)}</stack>'
    head = '<?xml version="1.0" encoding="UTF-8"?>'
    return write(path, f'{head}<image w="{artwork.width}" h="{artwork.height}">{stack}</image>', **pictures)
