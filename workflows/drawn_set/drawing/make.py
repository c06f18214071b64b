"""Draw the pictures of the set: illustrations, masks, layers and scenes."""

from __future__ import annotations

import argparse
import importlib
import json
import sys
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from paint import Sheet
from PIL import Image

NAMES = ("banner", "fox", "jellyfish", "manga_cape", "portrait", "willow", "windy_girl")
HERE = Path(__file__).resolve().parent


def composed(sheets: list[Sheet]) -> tuple[Any, dict[str, Any]]:
    """The picture, uint8 [h, w, 3]; and how much of each moving layer is seen, uint8 [h, w]."""
    picture, seen = None, {}
    for sheet in sheets:
        own = sheet.pixels()
        share = own[..., 3:]
        picture = own[..., :3] if picture is None else picture * (1 - share) + own[..., :3]
        for name in seen:
            seen[name] = seen[name] * (1 - share[..., 0])
        if sheet.moves:
            before = seen.get(sheet.name, np.zeros_like(share[..., 0]))  # two layers of one name are one part
            seen[sheet.name] = np.minimum(1, before + share[..., 0])
    assert picture is not None
    masks = {name: np.rint(255 * np.clip(mask, 0, 1)).astype(np.uint8) for name, mask in seen.items()}
    return np.rint(np.clip(picture, 0, 255)).astype(np.uint8), masks


def save_picture(pixels: Any, folder: Path, quality: int | None) -> None:
    image = Image.fromarray(pixels[..., 0] if (pixels == pixels[..., :1]).all() else pixels)
    if quality:
        image.save(folder / "illustration.jpg", quality=quality, subsampling=0, optimize=True)
    else:
        image.save(folder / "illustration.png", optimize=True)


def save_layers(sheets: list[Sheet], path: Path) -> None:
    """The picture in layers, those hidden by others whole; needs PhysAnimator, installed."""
    from physanimator.rendering.artwork import ArtLayer, Artwork, save_psd, trimmed

    layers = []
    for sheet in sheets:
        own = sheet.pixels()
        straight = own[..., :3] / np.maximum(own[..., 3:], 1e-4)
        pixels = np.rint(np.clip(np.dstack([straight, 255 * own[..., 3]]), 0, 255)).astype(np.uint8)
        pixels[pixels[..., 3] == 0] = 0
        layers.append(trimmed(ArtLayer(sheet.name, pixels)))
    save_psd(Artwork(sheets[0].width, sheets[0].height, tuple(layers)), path, small=True)


def make(name: str, out: Path, *, layered: bool = True) -> None:
    """Draw one picture into a folder of its name."""
    module = importlib.import_module(name)
    folder = out / name
    folder.mkdir(parents=True, exist_ok=True)
    sheets = module.draw()
    picture, masks = composed(sheets)
    finish = getattr(module, "finish", None)
    save_picture(picture if finish is None else finish(picture), folder, getattr(module, "QUALITY", None))
    for part, mask in masks.items():
        grown = np.maximum(mask, cv2.GaussianBlur(mask, (3, 3), 0))
        grown = np.minimum(255, grown * getattr(module, "SOLID", 1.0))
        levels = (np.rint(grown / 5) * 5).astype(np.uint8)  # 52 of them, which makes small files
        Image.fromarray(levels).save(folder / f"mask_{part.replace(' ', '_')}.png", optimize=True)
    width, height = module.SIZE
    scene = {"version": 2, "width": width, "height": height, "frame_rate": 24, **module.SCENE}
    (folder / "scene.json").write_text(json.dumps(scene, indent=1) + "\n", encoding="utf-8")
    if layered and getattr(module, "LAYERED", False):
        save_layers(sheets, folder / "illustration.psd")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", default=NAMES)
    parser.add_argument("--out", type=Path, default=HERE.parent)
    options = parser.parse_args()
    for name in options.names:
        make(name, options.out)
        size = sum(path.stat().st_size for path in (options.out / name).iterdir())
        print(f"{name}: {size // 1024} KB", file=sys.stderr)


if __name__ == "__main__":
    main()
