"""Soft alpha against the true alpha of layered pictures.

    python tests/benchmarks/matte.py FOLDER --json

FOLDER holds layered samples, one folder each, with composite.png, sprite.png (RGBA) and background.png. The matte sees
the composite and a hard mask of the sprite (its alpha above one half), exact, shrunk and grown by a pixel; behind it
either the true background or the clean plate that this package paints. Measured within --band pixels of the sprite's
edge, away from the picture's border:

- "sad": sum of absolute differences to the true alpha, in thousands of pixels, and "mae", their mean;
- "halo": mean error of the colours when the cut-out sprite is laid over white, black and the picture turned upside
  down [8-bit steps].

The hard mask itself is measured in the same way.

Then masks as people make them - blurred, grown, shrunk, scaled, painted by hand, compressed - and the sprite's own
alpha, each made regular and matted as the renderer does it:

- "ghost": pixels within ten of the edge where the picture behind the moved sprite is darker than the true background by
  --darker 8-bit steps and as dark as the drawing was there, once with the mask as given and once made regular;
- "marks": those of them that stand out as much from what is around them as well, more than in the true background:
  an eye sees these, and not that a whole cloud has been painted darker;
- "mask": pixels further than one from the edge that the mask has wrong, before and after.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import cv2
import mask_variants
import numpy as np
import source_tree  # noqa: F401  (loads this source tree as the package physanimator)
from physanimator.rendering.matting import fitting_plate, mixed_rim, regular_mask, soft_alpha, with_outline
from physanimator.rendering.pictures import load_image
from physanimator.rendering.plate import fill_hole
from PIL import Image

MASKS = {"exact": 0, "shrunk": -1, "grown": 1}
SQUARE = np.ones((3, 3), np.uint8)
AROUND = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (21, 21))


def read(folder: Path) -> tuple[np.ndarray, ...]:
    """Composite, sprite's colour and alpha, and background, float32 in 0 to 1."""
    with Image.open(folder / "sprite.png") as picture:
        sprite = np.asarray(picture.convert("RGBA")).astype(np.float32) / 255
    composite, background = (
        load_image(folder / f"{name}.png") / np.float32(255) for name in ("composite", "background")
    )
    return composite, sprite[..., :3], sprite[..., 3], background


def hard_mask(alpha: np.ndarray, change: int) -> np.ndarray:
    """Alpha above one half, shrunk or grown."""
    mask = (alpha > 0.5).astype(np.uint8)
    return (cv2.dilate(mask, SQUARE) if change > 0 else cv2.erode(mask, SQUARE) if change < 0 else mask) > 0


def band_of(alpha: np.ndarray, width: int) -> np.ndarray:
    """Pixels near the edge."""
    inside = alpha > 0.5
    edge = cv2.morphologyEx(inside.astype(np.uint8), cv2.MORPH_GRADIENT, SQUARE)
    return cv2.distanceTransform(1 - edge, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) <= width


def judged(image: np.ndarray, plate: np.ndarray, alpha: np.ndarray, truth: tuple[np.ndarray, ...]) -> dict[str, float]:
    """Errors of one alpha."""
    colour, true_alpha, band = truth
    error = np.abs(alpha - true_alpha)[band]
    cut_out = image - (1 - alpha[..., None]) * fitting_plate(image, plate, alpha)
    halo = []
    for behind in (np.ones_like(image), np.zeros_like(image), image[::-1]):
        ours = cut_out + (1 - alpha[..., None]) * behind
        theirs = true_alpha[..., None] * colour + (1 - true_alpha[..., None]) * behind
        halo.append(np.abs(np.clip(ours, 0, 1) - theirs)[band].mean() * 255)
    return {"sad": float(error.sum() / 1000), "mae": float(error.mean()), "halo": float(np.mean(halo))}


def measure(folder: Path, band: int) -> dict[str, Any]:
    """Errors of the hard mask and of the matte, by mask and plate."""
    image, colour, alpha, background = read(folder)
    truth = (colour, alpha, band_of(alpha, band))
    table: dict[str, Any] = {}
    for name, change in MASKS.items():
        mask = hard_mask(alpha, change)
        soft = mask.astype(np.float32)
        support = with_outline(image, soft)
        painted = fill_hole(image, cv2.dilate(support.astype(np.uint8), SQUARE, iterations=2) > 0)
        for plate_name, plate in (("true plate", background), ("clean plate", painted)):
            row = {"hard": judged(image, plate, soft, truth)}
            row["soft"] = judged(image, plate, soft_alpha(image, plate, soft, support), truth)
            table[f"{name} mask, {plate_name}"] = row
    return table


def behind(image: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """What the renderer shows behind a moved part."""
    support = with_outline(image, mask)
    plate = fill_hole(image, support | mixed_rim(mask, support))
    return fitting_plate(image, plate, soft_alpha(image, plate, mask, support))


def standing_out(lightness: np.ndarray) -> np.ndarray:
    """How much darker than what is around them pixels are."""
    return cv2.morphologyEx(lightness, cv2.MORPH_CLOSE, AROUND) - lightness


def ghosts(folder: Path, darker: float) -> dict[str, Any]:
    """What stays behind of the sprite's outline, and what masks have wrong, by mask."""
    image, _, alpha, background = read(folder)
    light = np.float32([0.299, 0.587, 0.114])
    near, beside = band_of(alpha, 10), band_of(alpha, 1)
    table = {}
    for name, change in mask_variants.VARIANTS.items():
        given = change(alpha)
        row: dict[str, Any] = {"ghost": [], "marks": [], "mask": []}
        for mask in (given, regular_mask(image, given)):
            left = behind(image, mask) @ light
            dark = near & (left < background @ light - darker / 255) & (np.abs(left - image @ light) < 0.1)
            row["ghost"].append(int(dark.sum()))
            seen = standing_out(left) - standing_out(background @ light) > darker / 255
            row["marks"].append(int((dark & seen).sum()))
            row["mask"].append(int((((mask > 0.5) != (alpha > 0.5)) & ~beside).sum()))
        table[name] = row
    return table


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--band", type=int, default=6, help="width of the band on either side of the edge (default 6)")
    parser.add_argument("--darker", type=float, default=38, help="what is seen as a ghost [8-bit steps] (default 38)")
    parser.add_argument("--json", action="store_true", help="print the whole document")
    options = parser.parse_args()
    folders = sorted(path.parent for path in options.folder.glob("*/sprite.png"))
    document = {folder.name: measure(folder, options.band) for folder in folders}
    made = {folder.name: ghosts(folder, options.darker) for folder in folders}
    if options.json:
        print(json.dumps({"matte": document, "masks": made}, indent=2))
        return
    for sample, table in document.items():
        for name, row in table.items():
            figures = [f"{kind}: " + " ".join(f"{key} {value:.4f}" for key, value in row[kind].items()) for kind in row]
            print(f"{sample:>20} {name:>25}  " + "   ".join(figures))
    for sample, table in made.items():
        for name, row in table.items():
            print(f"{sample:>20} {name:>25}  " + "   ".join(f"{key} {a:5d} -> {b:5d}" for key, (a, b) in row.items()))


if __name__ == "__main__":
    main()
