"""Draws the pictures that the guide animates beside the bundled example: ``python nodes/docs/files/draw.py``."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

HERE = Path(__file__).resolve().parent
FINE = 4  # drawn this much larger, then reduced: smooth edges
LINE = (46, 30, 40)


def main() -> None:
    """Write the banner with its mask, and the logo with its mask."""
    for name, drawn in {"banner": _banner(), "logo": _logo()}.items():
        picture, mask = drawn
        picture.save(HERE / f"{name}.png", optimize=True)
        mask.save(HERE / f"{name}_mask.png", optimize=True)


def _reduced(picture: Image.Image) -> Image.Image:
    return picture.resize((picture.width // FINE, picture.height // FINE), Image.Resampling.LANCZOS)


def _wave(x0: float, x1: float, y: float, height: float, bends: float = 1.0, n: int = 60) -> list[tuple[float, float]]:
    x = np.linspace(x0, x1, n)
    return [(a, b) for a, b in zip(x, y + height * np.sin((x - x0) / (x1 - x0) * 2 * np.pi * bends), strict=True)]


def _banner() -> tuple[Image.Image, Image.Image]:
    """A banner on the pole of a tower, 640 x 400, and a mask of its cloth."""
    width, height = 640 * FINE, 400 * FINE
    t = np.linspace(0, 1, height)[:, None, None]
    sky = (1 - t) * np.array((96, 168, 226)) + t * np.array((236, 240, 226))
    picture = Image.fromarray(np.uint8(np.broadcast_to(sky, (height, width, 3))))
    draw = ImageDraw.Draw(picture)
    s = FINE
    for x, y, r in ((430, 300, 46), (480, 282, 60), (545, 300, 50), (60, 250, 36), (20, 236, 50)):
        draw.ellipse(((x - r) * s, (y - r) * s, (x + r) * s, (y + r) * s), fill=(250, 252, 252))
    draw.polygon(
        [(0, height), *[(x, y) for x, y in _wave(0, width, 336 * s, 14 * s, 1.5)], (width, height)], (118, 170, 96)
    )
    _tower(draw)
    mask = Image.new("L", picture.size)
    outline = [
        *_wave(150 * s, 520 * s, 84 * s, 12 * s),
        (466 * s, 146 * s),
        *_wave(150 * s, 530 * s, 214 * s, 12 * s)[::-1],
    ]
    for where, fill in ((draw, (198, 44, 58)), (ImageDraw.Draw(mask), 255)):
        where.polygon(outline, fill=fill)
        where.line([*outline, outline[0]], fill=LINE if where is draw else 255, width=4 * s, joint="curve")
    for y in (108, 190):
        draw.line(_wave(154 * s, 474 * s, y * s, 11 * s, 0.87), fill=(246, 208, 92), width=7 * s)
    _star(draw, 268 * s, 152 * s, 34 * s)
    draw.rounded_rectangle((138 * s, 44 * s, 152 * s, 340 * s), 6 * s, fill=(120, 84, 58), outline=LINE, width=3 * s)
    draw.ellipse((131 * s, 30 * s, 159 * s, 58 * s), fill=(246, 208, 92), outline=LINE, width=3 * s)
    return _reduced(picture), _reduced(mask)


def _tower(draw: ImageDraw.ImageDraw) -> None:
    s = FINE
    draw.rectangle((70 * s, 300 * s, 226 * s, 400 * s), fill=(176, 170, 176), outline=LINE, width=3 * s)
    for x in range(64, 220, 34):
        draw.rectangle((x * s, 280 * s, (x + 22) * s, 304 * s), fill=(190, 184, 188), outline=LINE, width=3 * s)
    for row, y in enumerate((322, 346, 370)):
        for x in range(82 + 20 * (row % 2), 210, 40):
            draw.line((x * s, y * s, (x + 16) * s, y * s), fill=(138, 132, 140), width=3 * s)


def _star(draw: ImageDraw.ImageDraw, x: float, y: float, radius: float) -> None:
    turns = [(radius if k % 2 == 0 else 0.42 * radius, (k / 10) * 2 * np.pi - np.pi / 2) for k in range(10)]
    draw.polygon(
        [(x + r * np.cos(a), y + r * np.sin(a)) for r, a in turns], fill=(246, 208, 92), outline=LINE, width=10
    )


def _logo() -> tuple[Image.Image, Image.Image]:
    """A word under a sprout of three leaves, on transparency, 480 x 360, and a mask of the sprout."""
    s = FINE
    picture = Image.new("RGBA", (480 * s, 360 * s), (0, 0, 0, 0))
    sprout = Image.new("RGBA", picture.size, (0, 0, 0, 0))
    draw = ImageDraw.Draw(sprout)
    draw.line(
        _curve((240, 262), (236, 190), (244, 130), (240, 96)), fill=(38, 92, 66, 255), width=11 * s, joint="curve"
    )
    for tip, bulge, colour in (
        ((120, 92), 42, (74, 158, 96, 255)),
        ((368, 84), -42, (96, 182, 104, 255)),
        ((250, 10), 34, (132, 204, 112, 255)),
    ):
        root = (240, 100) if tip[1] < 50 else (240, 176)
        leaf = _leaf(root, tip, bulge)
        draw.polygon(leaf, fill=colour)
        draw.line([*leaf, leaf[0]], fill=(38, 92, 66, 255), width=5 * s, joint="curve")
        draw.line(((root[0] * s, root[1] * s), (tip[0] * s, tip[1] * s)), fill=(38, 92, 66, 255), width=3 * s)
    picture.alpha_composite(sprout)
    draw = ImageDraw.Draw(picture)
    draw.rounded_rectangle((40 * s, 254 * s, 440 * s, 334 * s), 40 * s, fill=(38, 92, 66, 255))
    draw.text((240 * s, 293 * s), "greenhouse", font=ImageFont.load_default(56 * s), fill="white", anchor="mm")
    mask = sprout.getchannel("A").point(lambda value: 255 if value else 0)
    ImageDraw.Draw(mask).rounded_rectangle((40 * s, 254 * s, 440 * s, 334 * s), 40 * s, fill=0)
    return _reduced(picture), _reduced(mask)


def _curve(*points: tuple[float, float]) -> list[tuple[float, float]]:
    t = np.linspace(0, 1, 40)[:, None]
    a, b, c, d = np.array(points, float) * FINE
    curve = (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d
    return [(x, y) for x, y in curve]


def _leaf(root: tuple[float, float], tip: tuple[float, float], bulge: float) -> list[tuple[float, float]]:
    a, b = np.array(root, float), np.array(tip, float)
    across = np.array([-(b - a)[1], (b - a)[0]]) / np.hypot(*(b - a)) * abs(bulge)
    upper = _curve(tuple(a), tuple(a + 0.3 * (b - a) + across), tuple(a + 0.7 * (b - a) + across), tuple(b))
    lower = _curve(tuple(b), tuple(a + 0.7 * (b - a) - across), tuple(a + 0.3 * (b - a) - across), tuple(a))
    return upper + lower


if __name__ == "__main__":
    main()
