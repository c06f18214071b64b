"""Draws the project's icon and banner, from curves and the bundled example: ``python nodes/docs/emblem/draw.py``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

HERE = Path(__file__).resolve().parent
EXAMPLE = HERE.parents[2] / "workflows" / "example" / "illustration.png"
ICON = 400
BANNER = (1260, 540)
FINE = 4  # drawn this much larger, then reduced: smooth edges

NIGHT, SKY, LINE = (24, 42, 74), (120, 196, 232), (62, 24, 32)
LOCKS = (
    ((0.20, 0.28), (0.50, 0.08), (0.62, 0.52), (0.93, 0.25), (196, 88, 62)),
    ((0.20, 0.42), (0.46, 0.34), (0.62, 0.84), (0.95, 0.53), (224, 122, 74)),
    ((0.20, 0.56), (0.38, 0.60), (0.52, 1.06), (0.86, 0.80), (178, 74, 58)),
)
"""Locks of hair: the four points of a Bezier curve in sides of the icon, from the root to the tip, and a colour."""


def main() -> None:
    """Write ``icon.png`` and ``banner.jpg`` beside this file."""
    icon = _icon(ICON)
    icon.save(HERE / "icon.png", optimize=True)
    _banner(icon).save(HERE / "banner.jpg", quality=88, optimize=True)


def _icon(side: int) -> Image.Image:
    large = side * FINE
    picture = _gradient(large, large, lambda x, y: y)
    draw = ImageDraw.Draw(picture)
    for *points, colour in LOCKS:
        curve = _bezier(np.array(points) * large)
        draw.polygon(_lock(curve, 0.115 * large), fill=LINE)
        draw.polygon(_lock(curve, 0.095 * large), fill=colour)
        draw.line(
            [tuple(each) for each in curve[6:70]], fill=tuple(min(255, c + 46) for c in colour), width=large // 70
        )
    for *points, _colour in LOCKS:
        _dot(draw, points[0][0] * large, points[0][1] * large, 0.062 * large, LINE)
        _dot(draw, points[0][0] * large, points[0][1] * large, 0.044 * large, (255, 205, 70))
    rounded = Image.new("L", (large, large))
    ImageDraw.Draw(rounded).rounded_rectangle((0, 0, large - 1, large - 1), large * 0.2, fill=255)
    picture.putalpha(rounded)
    return picture.resize((side, side), Image.Resampling.LANCZOS)


def _banner(icon: Image.Image) -> Image.Image:
    width, height = BANNER
    art = Image.open(EXAMPLE).convert("RGB")
    art = art.resize((round(art.width * height / art.height), height), Image.Resampling.LANCZOS)
    banner = Image.new("RGB", BANNER, NIGHT)
    fade = np.clip((np.arange(art.width) - 40) / 220, 0, 1)
    shade = Image.fromarray(np.tile(np.uint8(255 * fade * fade * (3 - 2 * fade)), (height, 1)))
    banner.paste(art, (width - art.width, 0), shade)
    small = icon.resize((132, 132), Image.Resampling.LANCZOS)
    banner.paste(small, (44, 92), small)
    draw = ImageDraw.Draw(banner)
    draw.text((42, 246), "PhysAnimator", font=ImageFont.load_default(54), fill="white")
    draw.text(
        (44, 330), "One still illustration,\nmoved by physics", font=ImageFont.load_default(28), fill=SKY, spacing=10
    )
    return banner


def _bezier(points: NDArray[np.float64], samples: int = 90) -> NDArray[np.float64]:
    t = np.linspace(0, 1, samples)[:, None]
    a, b, c, d = points
    return (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d


def _lock(curve: NDArray[np.float64], width: float) -> list[tuple[float, float]]:
    """The outline of a lock that is broadest near its root and ends in a tip."""
    along = np.gradient(curve, axis=0)
    across = np.stack([-along[:, 1], along[:, 0]], 1) / np.linalg.norm(along, axis=1, keepdims=True)
    t = np.linspace(0, 1, len(curve))[:, None]
    half = width / 2 * (0.72 + 1.5 * t) * (1 - t**2.2)
    return [tuple(each) for each in np.concatenate([curve + across * half, (curve - across * half)[::-1]])]


def _dot(draw: ImageDraw.ImageDraw, x: float, y: float, radius: float, colour: tuple[int, int, int]) -> None:
    draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill=colour)


def _gradient(width: int, height: int, where: Callable[[NDArray, NDArray], NDArray]) -> Image.Image:
    y, x = np.mgrid[0:height, 0:width]
    t = (where(x / width, y / height))[..., None]
    return Image.fromarray(np.uint8((1 - t) * np.array((58, 122, 190)) + t * np.array(SKY)))


if __name__ == "__main__":
    main()
