#!/usr/bin/env python3
"""Regenerate the PNG files and the layers of the bundled example from illustration.svg.

Needs rsvg-convert (Debian/Ubuntu package librsvg2-bin), Pillow and numpy; for
illustration.psd also PhysAnimator itself, installed.

Every moving part is one group of the SVG.  A mask is made by painting that
group white and everything else black, so it holds exactly the pixels of the
part that can be seen, its dark outline included.  The clean plate is the
picture with all the moving groups left out.  A layer of illustration.psd is
some groups rendered alone, whatever lies over them in the picture.
"""

import argparse
import io
import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
from PIL import Image, ImageFilter

SVG = "http://www.w3.org/2000/svg"
SIZE = (1280, 720)
# mask name -> ids of the groups that belong to that part
PARTS = {
    "hair": ["hair_back"],
    "ribbon": ["ribbon"],
    "cape": ["cape"],
    "plant": ["plant"],
}
# layer of the PSD file -> ids of its groups, from back to front
LAYERS = {
    "background": ["background"],
    "back hair": ["hair_back"],
    "cape": ["cape"],
    "arms": ["arms"],
    "skirt": ["skirt"],
    "body": ["torso", "neck"],
    "collar": ["capelet", "collar"],
    "face": ["face", "features"],
    "front hair": ["hair_front"],
    "ribbon": ["ribbon"],
    "plant": ["plant"],
}
PAINT = ("fill", "stroke")


def rasterise(root, scale, background="black", mode="RGB"):
    """Render an SVG tree and return a picture `scale` times the final size."""
    run = subprocess.run(
        ["rsvg-convert", "-w", str(SIZE[0] * scale), "-h", str(SIZE[1] * scale), "-b", background],
        input=ET.tostring(root),
        stdout=subprocess.PIPE,
        check=True,
    )
    return Image.open(io.BytesIO(run.stdout)).convert(mode)


def repaint(elem, part_ids, after, inside=False, state=None):
    """Paint the part white, what lies above it `after`, all the rest black.

    Works in document order, which is painting order.
    """
    state = state if state is not None else {"seen": False}
    if elem.tag == f"{{{SVG}}}defs":
        return
    here = inside or elem.get("id") in part_ids
    colour = "#ffffff" if here else (after if state["seen"] else "#000000")
    for key in PAINT:
        if elem.get(key) not in (None, "none"):
            elem.set(key, colour)
    if elem.get("fill") is None and (elem.tag == f"{{{SVG}}}svg" or (here and not inside)):
        elem.set("fill", colour)
    for child in elem:
        repaint(child, part_ids, after, here, state)
    if here and not inside:
        state["seen"] = True
        elem.set("fill", "#ffffff")


def part_mask(svg_text, part_ids, scale):
    """Visible coverage of a part, grown by half a final pixel where nothing covers it.

    The growth makes sure that the faint rim of the anti-aliased outline is in the mask too.
    """
    root = ET.fromstring(svg_text)
    repaint(root, part_ids, "#000000")
    seen = rasterise(root, scale).convert("L")
    root = ET.fromstring(svg_text)
    repaint(root, part_ids, "#ff0000")
    cover = np.asarray(rasterise(root, scale), dtype=np.int16)
    cover = np.clip(cover[..., 0] - cover[..., 1], 0, 255)  # what is painted above the part
    grown = np.asarray(seen.filter(ImageFilter.MaxFilter(2 * (scale // 2) + 1)), dtype=np.int16)
    full = np.maximum(np.asarray(seen, dtype=np.int16), np.minimum(grown, 255 - cover))
    return Image.fromarray(full.astype(np.uint8)).reduce(scale)


def drop(elem, ids):
    for child in list(elem):
        if child.get("id") in ids:
            elem.remove(child)
        else:
            drop(child, ids)


def keep(elem, ids):
    """Leave nothing but these groups, and what is around them."""
    for child in list(elem):
        if child.get("id") in ids or child.tag == f"{{{SVG}}}defs":
            continue
        if any(inner.get("id") in ids for inner in child.iter()):
            keep(child, ids)
        else:
            elem.remove(child)


def layer(svg_text, ids, scale):
    """Straight RGBA of some groups alone, transparent pixels in black."""
    root = ET.fromstring(svg_text)
    keep(root, ids)
    large = np.asarray(rasterise(root, scale, "none", "RGBA")).astype(np.float64)
    large[..., :3] *= large[..., 3:] / 255
    small = large.reshape(SIZE[1], scale, SIZE[0], scale, 4).mean(axis=(1, 3))
    small[..., :3] = 255 * small[..., :3] / np.maximum(small[..., 3:], 1e-9)
    pixels = np.rint(np.minimum(small, 255)).astype(np.uint8)
    pixels[pixels[..., 3] == 0] = 0
    return pixels


def save_layers(svg_text, scale, path):
    """The picture in layers, those hidden by others whole."""
    from physanimator.rendering.artwork import ArtLayer, Artwork, save_psd, trimmed

    layers = [trimmed(ArtLayer(name, layer(svg_text, ids, scale))) for name, ids in LAYERS.items()]
    save_psd(Artwork(*SIZE, tuple(layers)), path, small=True)
    print(f"{path.name}: {len(layers)} layers")


def main():
    here = Path(__file__).resolve().parent
    ap = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    ap.add_argument("--svg", type=Path, default=here / "illustration.svg")
    ap.add_argument("--out", type=Path, default=here, help="folder for the files")
    ap.add_argument("--scale", type=int, default=2, help="supersampling factor (default 2)")
    args = ap.parse_args()
    text = args.svg.read_text(encoding="utf-8")
    args.out.mkdir(parents=True, exist_ok=True)

    def save(image, name):
        image.save(args.out / name, optimize=True)
        print(f"{name}: {image.size[0]}x{image.size[1]} {image.mode}")

    save(rasterise(ET.fromstring(text), args.scale).reduce(args.scale), "illustration.png")
    root = ET.fromstring(text)
    drop(root, {i for ids in PARTS.values() for i in ids})
    save(rasterise(root, args.scale).reduce(args.scale), "clean_plate.png")
    for name, ids in PARTS.items():
        save(part_mask(text, ids, args.scale), f"mask_{name}.png")
    save_layers(text, args.scale, args.out / "illustration.psd")


if __name__ == "__main__":
    main()
