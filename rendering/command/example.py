"""The bundled example: where it lies, and what is read of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

__all__ = ["EXAMPLE", "bundled_files", "read_example"]

EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example"
"""The folder of the bundled example."""


def bundled_files() -> list[Path]:
    """Every file of the bundled example that a command reads."""
    return sorted(path for path in EXAMPLE.iterdir() if path.suffix in (".json", ".png"))


def read_example() -> tuple[Any, list[Any], Any]:
    """The bundled illustration, the masks of its parts, and its scene document."""
    from ...physics.document import read_json
    from ..pictures import load_image, load_mask

    scene = read_json((EXAMPLE / "scene.json").read_text(encoding="utf-8"))
    image = load_image(EXAMPLE / "illustration.png")
    height, width = image.shape[:2]
    masks = [EXAMPLE / f"mask_{body['name']}.png" for body in scene["bodies"]]
    return image, [load_mask(path, width=width, height=height) for path in masks], scene
