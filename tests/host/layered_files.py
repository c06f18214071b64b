"""Small layered files, written by hand as Krita writes them, and graphs that move them."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from bar_graphs import core, ours
from PIL import Image

__all__ = ["HEIGHT", "WIDTH", "bust", "filled", "moved_layers", "upload", "write_ora"]

WIDTH, HEIGHT = 160, 96


def filled(colour: tuple[int, int, int], left: int, top: int, right: int, bottom: int) -> np.ndarray:
    """A layer of the canvas' size with a rectangle, RGBA."""
    pixels = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    pixels[top:bottom, left:right] = (*colour, 255)
    return pixels


def bust() -> list[tuple[str, np.ndarray]]:
    """From back to front: paper, hair that hangs behind a face, the face, and a fringe over it."""
    paper = np.dstack([*np.mgrid[0:HEIGHT, 0:WIDTH], *np.full((2, HEIGHT, WIDTH), 255)]).astype(np.uint8)
    return [
        ("background", paper),
        ("後ろ髪", filled((200, 40, 40), 50, 10, 110, 84)),
        ("face", filled((250, 220, 180), 60, 20, 100, 60)),
        ("前髪", filled((240, 60, 60), 64, 12, 96, 34)),
    ]


def write_ora(path: Path, layers: Sequence[tuple[str, np.ndarray]]) -> None:
    """An OpenRaster file of layers of one size, given from back to front."""
    path.parent.mkdir(parents=True, exist_ok=True)
    height, width = layers[0][1].shape[:2]
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mimetype", "image/openraster")
        entries = []
        for number, (name, pixels) in enumerate(layers):
            encoded = io.BytesIO()
            Image.fromarray(pixels).save(encoded, "png")
            archive.writestr(f"data/{number}.png", encoded.getvalue())
            entries.insert(0, f'<layer name={quoteattr(name)} src="data/{number}.png" x="0" y="0"/>')
        archive.writestr("stack.xml", f'<image w="{width}" h="{height}"><stack>{"".join(entries)}</stack></image>')


def moved_layers(file: str, frames: int = 5, **changes: Any) -> dict[str, Any]:
    """A file, its bodies in a strong wind, and their motion."""
    usual = {"layers": ["load", 0], "move": "", "still": "", "preset": "by name", "spacing": 8.0, "elements_across": 2,
             "strands": True}  # fmt: skip
    return {
        "load": ours("LoadLayers", file=file),
        "bodies": ours("ArtworkToBodies", **(usual | changes)),
        "scene": ours("AutomaticScene", bodies=["bodies", 0], wind_strength=4.0, wind_angle=0.0, sway_by_size=True,
                      frame_rate=12.0),
        "motion": ours("Simulate", scene=["scene", 0], frames=frames),
        "render": ours("Render", image=["bodies", 1], motion=["motion", 0]),
        "seen": core("PreviewImage", images=["render", 0]),
        "flat": core("PreviewImage", images=["load", 1]),
        "report": core("PreviewAny", source=["bodies", 2]),
    }  # fmt: skip


def upload(host: Any, name: str, data: bytes) -> dict[str, Any]:
    """Post a file to the host as the page does; what the host answers."""
    import json
    import urllib.request

    line = "x-boundary"
    head = f'--{line}\r\nContent-Disposition: form-data; name="image"; filename="{name}"\r\n\r\n'.encode()
    request = urllib.request.Request(
        f"{host.url}/upload/image",
        head + data + f"\r\n--{line}--\r\n".encode(),
        {"Content-Type": f"multipart/form-data; boundary={line}"},
    )
    with urllib.request.urlopen(request, timeout=60) as answer:
        return json.loads(answer.read())
