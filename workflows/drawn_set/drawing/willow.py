"""A willow by a pond in watercolour: washes with soft and dark edges on granular paper, no lines."""

from __future__ import annotations

import cv2
import numpy as np
from paint import FINE, Array, Sheet, mixed, spline, tapered

SIZE = (880, 620)
QUALITY = 86
SOLID = 3.0  # times as opaque as the washes are their masks, as people paint masks
PAPER = "#faf6ea"


def _wash(sheet: Sheet, shape: Array, colour: object, strength: float, soft: float, rim: float = 0.35) -> None:
    """A wash: pigment gathers at its edge and lies unevenly on the paper."""
    mask = np.zeros(sheet.alpha.shape, np.uint8)
    cv2.fillPoly(mask, [np.rint(np.asarray(shape) * FINE * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
    full = mask.astype(np.float32) / 255
    edge = cv2.GaussianBlur(full, (0, 0), soft * FINE)
    wide = cv2.GaussianBlur(full, (0, 0), (2 * soft + 5) * FINE)
    uneven = 1 + 0.16 * sheet.noise(60) + 0.06 * sheet.noise(3)
    sheet.lay(np.clip(edge * (strength + rim * np.clip(1 - wide, 0, 1)) * uneven, 0, 1), colour)  # type: ignore[arg-type]


def scenery() -> Sheet:
    sheet = Sheet("scenery", *SIZE)
    sheet.cover(PAPER)
    x = np.linspace(-30, 910, 80)
    sky = np.vstack([np.stack([x, 262 + 16 * np.sin(x / 60)], 1), [(910, -40), (-30, -40)]])
    _wash(
        sheet, sky, sheet.gradient([(0, "#7fb3d6"), (0.55, "#c9dfe6"), (1, "#f6dcc0")], (0, 0), (0, 280)), 0.75, 14, 0.1
    )
    for y, high, tone, strength in ((250, 46, "#9bb0c9", 0.6), (286, 34, "#86a8a0", 0.65), (318, 22, "#7d9f6c", 0.7)):
        ridge = y + high * (0.5 * np.sin(x / 130 + y) + 0.3 * np.sin(x / 47 + 2 * y))
        _wash(sheet, np.vstack([np.stack([x, ridge], 1), [(910, 372), (-30, 372)]]), tone, strength, 2.5)
    pond = np.vstack([np.stack([x, 366 + 5 * np.sin(x / 70)], 1), [(910, 660), (-30, 660)]])
    _wash(
        sheet,
        pond,
        sheet.gradient([(0, "#cfe0dd"), (0.4, "#93bcc4"), (1, "#4c8197")], (0, 370), (0, 620)),
        0.85,
        2,
        0.1,
    )
    for _ in range(46):
        px, py = sheet.chance.uniform(0, 880), 384 + 210 * sheet.chance.random()
        wide = 14 + (py - 370) * 0.3 * sheet.chance.random()
        tone = ("#f2f5ee", "#5d8f6c", "#38697f")[int(sheet.chance.integers(3))]
        sheet.line(
            [(px - wide, py), (px, py + 2), (px + wide, py)],
            2 + (py - 370) / 60,
            tone,
            taper=tapered(0.5, 0.5),
            opacity=0.35,
            blur=1.2,
        )
    for px, py, size in ((470, 520, 24), (540, 548, 32), (618, 510, 20), (700, 560, 30)):
        ring = np.linspace(0.5, 2 * np.pi - 0.1, 40)
        pad = np.vstack([np.stack([px + size * np.cos(ring), py + 0.36 * size * np.sin(ring)], 1), [(px, py)]])
        _wash(sheet, pad, "#5f9a5c", 0.75, 0.6, 0.5)
    for dx, dy in ((0, 0), (-8, 3), (8, 3), (-4, -4), (4, -4)):
        sheet.fill(
            [(548 + dx, 528 + dy), (553 + dx, 536 + dy), (548 + dx, 544 + dy), (543 + dx, 536 + dy)],
            "#e58aa2",
            opacity=0.75,
            blur=0.6,
        )
    bank = spline([(-40, 470), (70, 452), (190, 458), (290, 486), (350, 540), (360, 660), (-40, 660)], closed=True)
    _wash(sheet, bank, sheet.gradient([(0, "#8fae58"), (1, "#4a6f3f")], (0, 450), (0, 620)), 0.92, 2)
    for _ in range(260):
        px = sheet.chance.uniform(-5, 345)
        py = 474 + 0.0007 * (px - 60) ** 2 + sheet.chance.uniform(0, 120)
        tone = mixed("#a9c46a", "#3d6340", sheet.chance.random())
        sheet.line(
            [(px, py), (px + 3, py - 12), (px + 9, py - 24)], 3, tone, taper=tapered(0, 1), opacity=0.6, blur=0.4
        )
    trunk = spline(
        [
            (86, 510),
            (112, 440),
            (120, 340),
            (108, 220),
            (84, 110),
            (60, -30),
            (150, -30),
            (160, 90),
            (178, 210),
            (180, 340),
            (194, 440),
            (238, 516),
            (160, 500),
        ],
        closed=True,
    )
    _wash(
        sheet, trunk, sheet.gradient([(0, "#6d5a4c"), (0.5, "#8c7460"), (1, "#4a3c3a")], (90, 0), (190, 0)), 0.95, 1.0
    )
    for k in range(26):
        px = 112 + 60 * sheet.chance.random()
        py = sheet.chance.uniform(10, 420)
        sheet.line(
            [(px - 8, py), (px, py + 30), (px + 4, py + 64)],
            4,
            ("#3e3230", "#b39a80")[k % 2],
            taper=tapered(0.4, 0.7),
            opacity=0.4,
            blur=0.6,
            inside=True,
        )
    for path, wide in (
        ([(142, 300), (150, 190), (178, 112), (240, 62), (360, 26), (560, 34), (760, 22)], 34),
        ([(128, 230), (112, 130), (60, 52), (-30, 12)], 30),
        ([(360, 30), (430, 4), (520, -20)], 16),
    ):
        sheet.line(
            path, wide, "#5f4d43", taper=lambda t: np.minimum(1, 0.2 + 3 * t) * (1 - 0.72 * t), opacity=0.92, blur=0.8
        )
    return sheet


def twigs(name: str, seed: int, count: int, tones: tuple[str, str, str]) -> Sheet:
    """A curtain of hanging twigs with narrow leaves."""
    sheet = Sheet(name, *SIZE, moves=True)
    chance = np.random.default_rng(seed)
    for k in range(count):
        x = 250 + 490 * (k + chance.uniform(0.1, 0.9)) / count
        top = float(np.interp(x, [230, 360, 560, 760], [64, 28, 34, 24])) - 4
        long = chance.uniform(0.6, 1.0) * (430 - 0.2 * abs(x - 520))
        lean = chance.uniform(4, 40)
        t = np.linspace(0, 1, 7)
        path = spline(np.stack([x + lean * t**1.6 + 7 * np.sin(4 * t + k), top + long * t], 1))
        sheet.line(path, 3.4, "#7c7a3e", taper=tapered(0, 0.9, 0.3), opacity=0.85)
        for place in range(8, len(path) - 1, 5):
            side = 1 if (place // 5) % 2 else -1
            _leaf(sheet, path[place], side, chance.uniform(17, 29), chance, tones)
        _leaf(sheet, path[-1], 0.15, 24, chance, tones)
    return sheet


def _leaf(
    sheet: Sheet, root: Array, side: float, long: float, chance: np.random.Generator, tones: tuple[str, str, str]
) -> None:
    angle = np.pi / 2 - side * chance.uniform(0.35, 0.75)
    tip = root + long * np.array([np.cos(angle), np.sin(angle)])
    middle = (root + tip) / 2 + (0, 2)
    tone = mixed(tones[int(chance.integers(3))], tones[0], 0.3 * chance.random())
    strength = chance.uniform(0.55, 0.95)
    sheet.line([root, middle, tip], 8.5, tone, taper=tapered(0.5, 0.6, 0.05), opacity=strength, blur=0.45)
    sheet.line(
        [root, middle, tip], 3.2, mixed(tone, "#24452f", 0.5), taper=tapered(0.5, 0.6, 0.05), opacity=0.35, blur=0.6
    )


def draw() -> list[Sheet]:
    back = twigs("twigs", 5, 17, ("#a9bd6a", "#8fae70", "#c9cd86"))
    front = twigs("twigs", 11, 14, ("#7f9f45", "#5f8a46", "#b3b552"))
    return [scenery(), back, front]


def finish(picture: Array) -> Array:
    """The paper's grain, in which pigment settles."""
    chance = np.random.default_rng(4)
    tooth = cv2.GaussianBlur(chance.normal(size=picture.shape[:2]).astype(np.float32), (0, 0), 0.9)
    tooth /= tooth.std()
    ink = (255 - picture.astype(np.float32)).mean(axis=2) / 255
    return np.rint(np.clip(picture + (tooth * (1.2 + 6 * ink))[..., None], 0, 255)).astype(np.uint8)


SCENE = {
    "bodies": [{"name": "twigs", "material": {"preset": "leaf", "sway_frequency": 0.45}}],
    "rig_points": [
        {"position": [500, 36], "body": 0, "motion": {"type": "pinned"},
         "region": {"type": "polygon", "points": [[225, 0], [225, 90], [300, 62], [365, 50], [560, 54], [770, 46], [780, 0]]}},
    ],
    "strokes": [
        {"kind": "wind", "path": [[180, 260], [420, 330], [650, 240], [900, 320]], "radius": 200, "speed": 480,
         "strength": 1.2, "interval": 1.3},
        {"kind": "wind", "path": [[190, 420], [430, 360], [660, 440], [900, 380]], "radius": 160, "speed": 420,
         "strength": 1.2, "start": 0.3, "interval": 1.5},
    ],
}  # fmt: skip
