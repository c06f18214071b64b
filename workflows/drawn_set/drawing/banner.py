"""A checked banner on a tower before summer clouds: line art and cel shading."""

from __future__ import annotations

import numpy as np
from paint import Array, Sheet, spline, tapered

SIZE = (960, 640)
LAYERED = True
INK = "#2b2140"


def sky() -> Sheet:
    sheet = Sheet("sky", *SIZE)
    sheet.cover(sheet.gradient([(0, "#2f7fd0"), (0.6, "#8fcdf0"), (1, "#fbe7c8")], (0, 0), (0, 640)))
    for x, y, size, seed in ((180, 560, 1.5, 3), (640, 600, 1.9, 8), (930, 470, 1.2, 5), (470, 640, 1.3, 1)):
        _cloud(sheet, x, y, size, seed)
    for k, (x, y) in enumerate(((470, 392), (524, 418), (432, 428))):
        span = 17 - 3 * k
        sheet.line([(x - span, y - 5), (x - 5, y - 8), (x, y)], 3, "#3d4f86", taper=tapered(0.5, 0.1))
        sheet.line([(x, y), (x + 5, y - 8), (x + span, y - 4)], 3, "#3d4f86", taper=tapered(0.1, 0.5))
    return sheet


def _cloud(sheet: Sheet, x: float, y: float, size: float, seed: int) -> None:
    chance = np.random.default_rng(seed)
    puffs = [(x + size * dx, y - size * dy, size * r) for dx, dy, r in _puffs(chance)]
    for dx, dy, colour in ((0, 0, "#a9c6ea"), (-4, -7, "#dcebf8"), (-9, -14, "#ffffff")):
        for px, py, radius in puffs:
            ring = np.linspace(0, 2 * np.pi, 40, endpoint=False)
            middle = (px + dx * size, py + dy * size)
            inner = radius - 0.35 * abs(dy) * size
            sheet.fill(
                np.stack([middle[0] + inner * np.cos(ring), middle[1] + inner * np.sin(ring)], 1), colour, sharp=True
            )


def _puffs(chance: np.random.Generator) -> list[tuple[float, float, float]]:
    found = []
    for dx in np.linspace(-85, 85, 9):
        top = 66 * np.cos(dx / 62) * (0.75 + 0.4 * chance.random())
        found += [(dx, max(top, 0), 24 + 9 * chance.random()), (dx, max(top, 0) / 2, 34), (dx * 1.15, -8, 26)]
    return found


def tower() -> Sheet:
    sheet = Sheet("tower", *SIZE)
    wall = np.array([(60, 660), (72, 404), (300, 404), (312, 660)], float)
    sheet.fill(wall, sheet.gradient([(0, "#e9dcc4"), (0.55, "#cdb79a"), (1, "#8f7c78")], (60, 0), (312, 0)), sharp=True)
    crown = [(44, 404), (44, 352), (50, 300), (92, 300), (92, 334), (126, 334), (126, 300), (170, 300), (170, 334)]
    crown += [
        (204, 334),
        (204, 300),
        (248, 300),
        (248, 334),
        (282, 334),
        (282, 300),
        (324, 300),
        (330, 352),
        (328, 404),
    ]
    top = np.array(crown, float)
    sheet.fill(top, sheet.gradient([(0, "#f3e9d6"), (0.55, "#d8c3a5"), (1, "#9a8680")], (44, 0), (330, 0)), sharp=True)
    sheet.fill(
        [(44, 388), (328, 388), (328, 416), (304, 420), (66, 420)], "#7d6a70", sharp=True, opacity=0.55, inside=True
    )
    for row in range(6):
        y = 356 + 44 * row
        sheet.line([(40, y), (332, y + 1)], 2.0, "#6d5a64", opacity=0.8, inside=True)
        for k in range(7):
            x = 40 + 52 * k + (row % 2) * 26
            sheet.line([(x, y), (x + 1, y + 44)], 1.8, "#6d5a64", opacity=0.7, inside=True)
            tone = "#fff6e2" if (3 * k + 5 * row) % 4 else "#b39a8a"
            sheet.fill(
                [(x + 4, y + 4), (x + 48, y + 4), (x + 48, y + 40), (x + 4, y + 40)], tone, opacity=0.22, inside=True
            )
    slit = np.array([(176, 500), (184, 478), (196, 478), (204, 500), (204, 572), (176, 572)], float)
    sheet.fill(slit, "#40324a", sharp=True)
    for shape in (wall, top, slit):
        sheet.outline(_dense(shape), 4.5, INK)
    for x, y in ((70, 640), (300, 612), (262, 648), (110, 656)):
        _ivy(sheet, x, y)
    sheet.line([(226, 344), (226, 22)], 13, INK)
    sheet.line([(226, 344), (226, 24)], 8.5, "#a56a35")
    sheet.line([(224, 344), (224, 24)], 2.5, "#d79a58")
    ring = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    ball = np.stack([226 + 12 * np.cos(ring), 20 + 12 * np.sin(ring)], 1)
    sheet.fill(ball, "#f2bf3c", sharp=True)
    sheet.outline(ball, 3.2, INK)
    sheet.fill(ball * 0.35 + (143, 10), "#fff2b8", sharp=True)
    return sheet


def _ivy(sheet: Sheet, x: float, y: float) -> None:
    for k in range(26):
        angle, far = sheet.chance.uniform(0, 2 * np.pi), 34 * np.sqrt(sheet.chance.random())
        px, py, size = x + far * np.cos(angle), y + far * np.sin(angle) * 0.8, sheet.chance.uniform(6, 10)
        leaf = [(px, py - size), (px + 0.8 * size, py), (px, py + size), (px - 0.8 * size, py)]
        sheet.fill(leaf, ("#3f7a4a", "#58994f", "#2f6045")[k % 3])


def _dense(corners: Array) -> Array:
    pieces = [spline([a, b]) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    return np.vstack(pieces)


def cloth(u: Array | float, v: Array | float) -> Array:
    """Where a place of the flag is, u along and v down it, both 0..1 [px]."""
    u, v = np.asarray(u, float), np.asarray(v, float)
    wave = 17 * np.sqrt(u) * np.sin(2 * np.pi * (1.25 * u - 0.12 * v) + 0.3)
    x = 233 + 600 * u + 10 * np.sin(2 * np.pi * 1.25 * u) * v - 14 * u * v
    return np.stack(np.broadcast_arrays(x, 58 + 34 * u + wave + v * (236 - 18 * u)), axis=-1)


def _region(sheet: Sheet, u0: float, u1: float, v0: float, v1: float, colour: str, **more: object) -> None:
    a, b = np.linspace(u0, u1, 60), np.linspace(v0, v1, 30)
    edge = np.vstack([cloth(a, v0), cloth(u1, b), cloth(a[::-1], v1), cloth(u0, b[::-1])])
    sheet.fill(edge, colour, sharp=True, **more)  # type: ignore[arg-type]


def flag() -> Sheet:
    sheet = Sheet("banner", *SIZE, moves=True)
    a, b = np.linspace(0, 1, 120), np.linspace(0, 1, 40)
    notch = np.concatenate([np.linspace(1, 0.86, 25), np.linspace(0.86, 1, 25)])
    edge = np.vstack([cloth(a, 0.0), cloth(notch, np.linspace(0, 1, 50)), cloth(a[::-1], 1.0), cloth(0.0, b[::-1])])
    sheet.fill(edge, "#c9283e", sharp=True)
    for k in range(14):
        for row in (0, 1):
            for v0 in (0.04, 0.84):
                if (k + row) % 2:
                    _region(sheet, k / 14, (k + 1) / 14, v0 + 0.06 * row, v0 + 0.06 * (row + 1), "#fff3dc", inside=True)
                else:
                    _region(sheet, k / 14, (k + 1) / 14, v0 + 0.06 * row, v0 + 0.06 * (row + 1), "#23346e", inside=True)
    for v in (0.0, 0.165, 0.815, 0.96):
        _region(sheet, 0, 1, v, v + 0.035, "#f4c244", inside=True)
    _region(sheet, 0.37, 0.40, 0.2, 0.815, "#f4c244", inside=True)
    _region(sheet, 0.0, 0.37, 0.2, 0.815, "#23346e", inside=True)
    _emblem(sheet)
    for k in range(3):
        _star(sheet, 0.50 + 0.13 * k, 0.5, 0.085 - 0.012 * k, "#fff3dc")
    shade, light = "#3a1440", "#ffffff"
    for k, middle in enumerate((0.13, 0.52, 0.93)):
        band = np.linspace(0, 1, 30)
        wide = 0.075 + 0.02 * np.sin(3 * band + k)
        left, right = cloth(middle - wide - 0.03 * band, band), cloth(middle + wide * 0.7 - 0.05 * band, band)
        sheet.fill(np.vstack([left, right[::-1]]), shade, sharp=True, opacity=0.30, inside=True)
        high = (
            cloth(middle + 0.20 - 0.045 * band, band),
            cloth(middle + 0.235 - 0.04 * band - 0.02 * np.sin(3 * band), band),
        )
        sheet.fill(np.vstack([high[0], high[1][::-1]]), light, sharp=True, opacity=0.26, inside=True)
    sheet.outline(edge, 5, INK)
    for middle in (0.055, 0.44, 0.85):
        band = np.linspace(0.02, 0.62, 30)
        sheet.line(cloth(middle - 0.05 * band, band), 3.2, INK, taper=tapered(0.1, 0.9), smooth=False)
        band = np.linspace(0.98, 0.6, 30)
        sheet.line(cloth(middle + 0.06 - 0.05 * band, band), 3.0, INK, taper=tapered(0.1, 0.9), smooth=False)
    for v in (0.04, 0.35, 0.66, 0.97):
        x, y = cloth(0.0, v)
        sheet.line([(x - 14, y), (x + 10, y + 1)], 7, INK)
        sheet.line([(x - 13, y), (x + 9, y + 1)], 3.5, "#f4c244")
    return sheet


def _emblem(sheet: Sheet) -> None:
    """A sun with rays in the canton."""
    for k in range(16):
        angle, long = 2 * np.pi * k / 16, 1.0 if k % 2 == 0 else 0.78
        t = np.array([angle - 0.13, angle, angle + 0.13])
        r = np.array([0.62, long, 0.62])
        _shape(sheet, t, r, "#f4c244")
    ring = np.linspace(0, 2 * np.pi, 50, endpoint=False)
    _shape(sheet, ring, np.full(50, 0.56), "#f4c244")
    _shape(sheet, ring, np.full(50, 0.46), "#e88a2e")
    _shape(sheet, ring, np.full(50, 0.38), "#f9d873")


def _shape(sheet: Sheet, angle: Array, radius: Array, colour: str) -> None:
    u, v = 0.185 + 0.115 * radius * np.cos(angle), 0.507 + 0.27 * radius * np.sin(angle)
    sheet.fill(cloth(u, v), colour, sharp=True, inside=True)


def _star(sheet: Sheet, u: float, v: float, size: float, colour: str) -> None:
    angle = np.linspace(0, 2 * np.pi, 10, endpoint=False) - np.pi / 2
    radius = size * np.where(np.arange(10) % 2, 0.42, 1.0)
    sheet.fill(
        cloth(u + radius * np.cos(angle) * 0.62, v + 1.5 * radius * np.sin(angle)), colour, sharp=True, inside=True
    )


def draw() -> list[Sheet]:
    return [sky(), tower(), flag()]


SCENE = {
    "bodies": [{"name": "banner", "attach": "left", "material": {"preset": "cloth", "sway_frequency": 0.7}}],
    "strokes": [
        {"kind": "wind", "path": [[150, 110], [330, 190], [520, 80], [720, 200], [950, 110]],
         "radius": 180, "speed": 700, "strength": 3.3, "interval": 0.9},
        {"kind": "wind", "path": [[150, 260], [330, 190], [520, 300], [720, 200], [950, 300]],
         "radius": 160, "speed": 620, "strength": 2.7, "start": 0.2, "interval": 1.1},
    ],
}  # fmt: skip
