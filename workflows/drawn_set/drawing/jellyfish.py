"""Glowing jellyfish in dark water: airbrush, soft edges, light that shines through; no lines."""

from __future__ import annotations

import numpy as np
from paint import Array, Sheet, mixed, spline, tapered

SIZE = (640, 880)
QUALITY = 90
SOLID = 3.0  # times as opaque as the parts are their masks, as people paint masks of what shines through


def sea() -> Sheet:
    sheet = Sheet("sea", *SIZE)
    sheet.cover(
        sheet.gradient([(0, "#2f8fb8"), (0.35, "#15507f"), (0.75, "#0b2450"), (1, "#070f2b")], (420, 0), (220, 880))
    )
    for k, x in enumerate((120, 250, 330, 470, 600)):
        wide = 26 + 12 * (k % 3)
        ray = [(x - wide, -30), (x + wide, -30), (x - 240 + 3.4 * wide, 990), (x - 300 - 2 * wide, 990)]
        sheet.fill(ray, "#bdf0ff", sharp=True, opacity=0.10, blur=16)
    for _ in range(150):
        x, y = sheet.chance.uniform(0, SIZE[0]), sheet.chance.uniform(0, SIZE[1])
        size = sheet.chance.uniform(0.6, 2.2) if sheet.chance.random() < 0.85 else sheet.chance.uniform(4, 11)
        _disc(sheet, x, y, size, "#c9f4ff", 0.5 if size < 3 else 0.13, 0.3 * size)
    for k in range(26):
        x = 25 * k + sheet.chance.uniform(-10, 10)
        tall = sheet.chance.uniform(40, 130) + 60 * abs(x / 320 - 1)
        bend = sheet.chance.uniform(-30, 30)
        path = [(x, 890), (x + 0.3 * bend, 880 - tall / 2), (x + bend, 880 - tall)]
        sheet.line(
            path, 13, mixed("#06122e", "#12406a", sheet.chance.random() * 0.6), taper=tapered(0.05, 1.0), blur=1.2
        )
    _small(sheet, 520, 640, 46)
    _small(sheet, 110, 560, 30)
    return sheet


def _disc(sheet: Sheet, x: float, y: float, size: float, colour: str, opacity: float, blur: float) -> None:
    ring = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    sheet.fill(
        np.stack([x + size * np.cos(ring), y + size * np.sin(ring)], 1), colour, sharp=True, opacity=opacity, blur=blur
    )


def _small(sheet: Sheet, x: float, y: float, size: float) -> None:
    """One far away, dim and still."""
    for k in range(6):
        at = x + size * (k - 2.5) * 0.26
        sheet.line(
            [(at, y), (at + 6, y + size), (at - 6, y + 2 * size)],
            3,
            "#7fb4e0",
            taper=tapered(0, 1),
            opacity=0.3,
            blur=1,
        )
    dome = [(x - size, y + 4), (x - 0.85 * size, y - 0.6 * size), (x, y - size), (x + 0.85 * size, y - 0.6 * size), (x + size, y + 4), (x, y + 0.3 * size)]  # fmt: skip
    sheet.fill(dome, "#6fa8dc", opacity=0.34, blur=2)
    sheet.fill([(px, py - 4) for px, py in dome[1:5]], "#d7f2ff", opacity=0.22, blur=4, inside=True)


def _wavy(x: float, y: float, long: float, lean: float, swing: float, phase: float) -> Array:
    t = np.linspace(0, 1, 9)
    side = lean * t**1.3 + swing * np.sqrt(t) * np.sin(2 * np.pi * (1.15 * t) + phase)
    return np.stack([x + side, y + long * t], axis=1)


def tentacles() -> Sheet:
    sheet = Sheet("tentacles", *SIZE, moves=True)
    for k in range(15):
        x = 158 + 23 * k
        long = 360 + 120 * np.sin(1.9 * k) + 40 * np.cos(0.7 * k)
        path = _wavy(x, 318, long, -26 + 14 * np.sin(k), 14, 0.55 * k)
        tone = mixed("#ff9ccf", "#b59cff", 0.5 + 0.5 * np.sin(1.3 * k))
        sheet.line(path, 8, tone, taper=tapered(0, 0.9, 0.25), opacity=0.16, blur=3)
        sheet.line(path, 3.2, mixed(tone, "#ffffff", 0.35), taper=tapered(0, 0.9, 0.3), opacity=0.75, blur=0.5)
        beads = spline(path)[:: 14 + k % 4]
        for px, py in beads:
            _disc(sheet, float(px), float(py), 1.9, "#fff1fb", 0.7, 0.5)
    return sheet


def arms() -> Sheet:
    """The frilled arms in the middle."""
    sheet = Sheet("tentacles", *SIZE, moves=True)
    for k, (x, long, lean) in enumerate(((286, 370, -76), (308, 460, -18), (336, 430, 44), (354, 340, 84))):
        path = spline(_wavy(x, 246, long, lean, 17, 1.2 * k))
        t = np.linspace(0, 1, len(path))
        frill = 34 * (1 - t) ** 0.6 * (0.62 + 0.30 * np.sin(55 * t + k) + 0.12 * np.sin(23 * t))
        frill *= np.clip(t / 0.2, 0.02, 1)
        band = np.vstack([path + np.stack([frill, 0 * t], 1), (path - np.stack([np.roll(frill, 9), 0 * t], 1))[::-1]])
        sheet.fill(band, mixed("#ff8fc0", "#ffc3a8", k / 4), sharp=True, opacity=0.42, blur=1.4)
        inner = np.vstack([path + np.stack([0.45 * frill, 0 * t], 1), (path - np.stack([0.4 * frill, 0 * t], 1))[::-1]])
        sheet.fill(inner, "#fff0e6", sharp=True, opacity=0.42, blur=1.6)
        for side in (1, -1):
            edge = path + np.stack([side * frill, 0 * t], 1)
            sheet.line(edge, 1.6, "#fff4fb", taper=tapered(0, 0.6), opacity=0.75, blur=0.4, smooth=False)
    return sheet


def bell() -> Sheet:
    sheet = Sheet("bell", *SIZE)
    x, y = sheet.grid()
    glow = np.exp(-(((x - 320) / 250) ** 2 + ((y - 240) / 210) ** 2))
    sheet.lay(0.34 * glow, "#ff9fd6")
    dome = [(124, 316), (128, 226), (178, 138), (256, 92), (320, 82), (384, 92), (462, 138), (512, 226), (516, 316)]
    hem = [(486, 336), (454, 322), (420, 344), (386, 328), (352, 350), (320, 334), (288, 350), (254, 328), (220, 344), (186, 322), (154, 336)]  # fmt: skip
    shape = spline([*dome, *hem], closed=True)
    body = sheet.gradient([(0, "#ffd9f2"), (0.45, "#f08fd0"), (1, "#7d63d8")], (270, 80), (350, 350))
    sheet.fill(shape, body, sharp=True, opacity=0.62, blur=1.2)
    sheet.fill(np.array(shape) * [0.8, 0.8] + [64, 74], "#5a3fae", sharp=True, opacity=0.22, blur=16, inside=True)
    for k in range(-5, 6):
        foot = 320 + 36 * k
        rib = [(320 + 3 * k, 96), (320 + 25 * k, 190), (foot, 326)]
        sheet.line(rib, 5, "#fff0ff", taper=tapered(0.7, 0.2), opacity=0.34, blur=1.5, inside=True)
    for angle in np.linspace(0, 2 * np.pi, 4, endpoint=False) + 0.6:
        cx, cy = 320 + 52 * np.cos(angle), 216 + 26 * np.sin(angle)
        ring = np.linspace(0, 2 * np.pi, 30, endpoint=False)
        petal = np.stack([cx + 32 * np.cos(ring), cy + 20 * np.sin(ring)], 1)
        sheet.fill(petal, "#ffe7b8", opacity=0.55, blur=3, inside=True)
        sheet.fill(petal * 0.55 + np.array([cx, cy]) * 0.45, "#ff7fb5", opacity=0.5, blur=3, inside=True)
    sheet.fill([(160, 240), (196, 160), (262, 112), (300, 108), (240, 150), (196, 214), (184, 262)], "#ffffff", opacity=0.6, blur=7, inside=True)  # fmt: skip
    sheet.fill([(478, 190), (500, 240), (504, 300), (484, 250)], "#bfe9ff", opacity=0.6, blur=6, inside=True)
    sheet.line(shape[: len(shape)], 3.2, "#fff0fb", opacity=0.55, blur=0.9, smooth=False)
    for k in range(60):
        px, py = sheet.chance.uniform(150, 490), sheet.chance.uniform(120, 320)
        _disc_inside(sheet, px, py, sheet.chance.uniform(1, 3.2), k)
    return sheet


def _disc_inside(sheet: Sheet, x: float, y: float, size: float, k: int) -> None:
    ring = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    shape = np.stack([x + size * np.cos(ring), y + size * np.sin(ring)], 1)
    sheet.fill(shape, ("#ffffff", "#ffd0f0")[k % 2], sharp=True, opacity=0.5, blur=0.7, inside=True)


def draw() -> list[Sheet]:
    return [sea(), tentacles(), arms(), bell()]


SCENE = {
    "bodies": [{"name": "tentacles", "attach": "top", "material": {"preset": "ribbon", "sway_frequency": 0.5}}],
    "strokes": [
        {"kind": "wind", "path": [[60, 380], [330, 470], [640, 400]], "radius": 150, "speed": 330, "strength": 0.9,
         "interval": 1.6},
        {"kind": "wind", "path": [[620, 640], [330, 560], [20, 660]], "radius": 170, "speed": 300, "strength": 0.9,
         "start": 0.6, "interval": 1.6},
    ],
}  # fmt: skip
