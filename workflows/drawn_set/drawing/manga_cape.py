"""A swordsman on a cliff, black and white as in print: ink, hatching and screen tone."""

from __future__ import annotations

import numpy as np
from paint import Array, Sheet, spline, tapered

SIZE = (640, 880)
INK, PAPER = "#15131a", "#ffffff"


def _tone(sheet: Sheet, level: Array | float, inside: bool = True, pitch: float = 5.0) -> None:
    """Screen tone at 45 degrees: dots whose area gives the grey, 0 white to 1 black."""
    x, y = sheet.grid()
    u, v = (x + y) / np.sqrt(2) / pitch, (x - y) / np.sqrt(2) / pitch
    far = np.hypot(u - np.round(u), v - np.round(v)) * pitch
    radius = pitch * np.sqrt(np.clip(level, 0, 1) / np.pi)
    sheet.lay(np.clip((radius - far) * 3 + 0.5, 0, 1) * (np.asarray(level) > 0.02), INK, inside=inside)


def sky() -> Sheet:
    sheet = Sheet("sky", *SIZE)
    sheet.cover(PAPER)
    x, y = sheet.grid()
    moon = np.hypot(x - 196, y - 214)
    level = 0.62 - 0.00062 * y - 0.42 * np.exp(-(((moon - 140) / 120) ** 2))
    _tone(sheet, np.where(moon < 128, 0, np.clip(level, 0.05, 0.7)), inside=False)
    ring = np.linspace(0, 2 * np.pi, 200)
    sheet.line(np.stack([196 + 128 * np.cos(ring), 214 + 128 * np.sin(ring)], 1), 2.2, INK, smooth=False)
    for px, py, wide in ((470, 330, 150), (110, 420, 130), (600, 470, 120)):
        puffs = [
            (px + wide * a, py - 0.28 * wide * b, 0.2 * wide * c)
            for a, b, c in ((-0.8, 0, 1), (-0.45, 0.5, 1.4), (0, 0.8, 1.7), (0.45, 0.4, 1.4), (0.85, 0, 1.0))
        ]
        for grow, colour in ((2.2, INK), (0, PAPER)):
            for a, b, r in puffs:
                circle = np.linspace(0, 2 * np.pi, 50)
                sheet.fill(
                    np.stack([a + (r + grow) * np.cos(circle), b + (r + grow) * np.sin(circle)], 1), colour, sharp=True
                )
            sheet.fill(
                [
                    (px - wide - grow, py - 4),
                    (px + wide + grow, py - 4),
                    (px + 1.15 * wide, py + 22 + grow),
                    (px - 1.15 * wide, py + 22 + grow),
                ],
                colour,
            )
        for k in range(9):
            a = px + wide * (k / 4.5 - 0.9)
            sheet.line([(a, py + 14), (a + 14, py + 4), (a + 30, py)], 2, INK, taper=tapered(0.2, 0.8))
    for _ in range(60):
        a, b = sheet.chance.uniform(-80, 600), sheet.chance.uniform(30, 700)
        if np.hypot(a + 60 - 196, b - 214) > 190:
            long = sheet.chance.uniform(60, 190)
            sheet.line(
                [(a, b), (a + long, b - 0.05 * long)], sheet.chance.uniform(1, 2.2), PAPER, taper=tapered(0.5, 0.5)
            )
    return sheet


def cliff() -> Sheet:
    sheet = Sheet("cliff", *SIZE)
    edge = [
        (-20, 758),
        (70, 736),
        (150, 744),
        (250, 726),
        (360, 732),
        (430, 744),
        (470, 770),
        (452, 812),
        (480, 850),
        (470, 900),
        (-20, 900),
    ]
    shape = np.array(edge, float)
    sheet.fill(shape, PAPER, sharp=True)
    sheet.fill(
        [(-20, 800), (120, 784), (210, 800), (300, 778), (400, 800), (452, 812), (480, 850), (470, 900), (-20, 900)],
        INK,
        sharp=True,
    )
    for _ in range(120):
        x = sheet.chance.uniform(-10, 452)
        y = float(np.interp(x, [p[0] for p in edge[:7]], [p[1] for p in edge[:7]]))
        long = sheet.chance.uniform(20, 62)
        sheet.line(
            [(x, y + sheet.chance.uniform(8, 40)), (x - 5, y + long), (x + 3, y + long + 22)],
            2.8,
            INK,
            taper=tapered(0.2, 0.7),
            inside=True,
        )
    for _ in range(60):
        x, y = sheet.chance.uniform(0, 450), sheet.chance.uniform(806, 880)
        sheet.line([(x, y), (x - 4, y + 16), (x + 5, y + 34)], 2, PAPER, taper=tapered(0.4, 0.6), inside=True)
    sheet.outline(spline(edge[:9]), 4.5, INK, closed=False)
    for _ in range(70):
        x = sheet.chance.uniform(0, 430)
        y = float(np.interp(x, [p[0] for p in edge[:7]], [p[1] for p in edge[:7]])) + 3
        sheet.line([(x, y), (x + 4, y - 10), (x + 13, y - 18)], 3, INK, taper=tapered(0, 1))
    return sheet


TOP = [(214, 352), (236, 338), (262, 336), (290, 344), (306, 356)]
HEM = [
    (196, 664),
    (226, 690),
    (262, 664),
    (306, 706),
    (352, 668),
    (404, 712),
    (454, 656),
    (510, 684),
    (556, 622),
    (604, 620),
]


def cape() -> Sheet:
    sheet = Sheet("cape", *SIZE, moves=True)
    right = [(560, 548), (486, 462), (392, 392)]
    left = [(206, 440), (196, 540)]
    edge = np.vstack([spline([TOP[0], *left, *HEM]), spline([HEM[-1], *right, TOP[-1]])[1:], spline(TOP[::-1])])
    sheet.fill(edge, PAPER, sharp=True)
    valleys = [(HEM[k], (HEM[k][0] * 0.55 + 262 * 0.45 + 10, 500 - 8 * k), TOP[min(k // 2, 4)]) for k in range(1, 9, 2)]
    under = Sheet("shade", *SIZE)
    for k, (low, middle, high) in enumerate(valleys):
        far = HEM[min(2 * k + 2, 9)]
        near = (np.array(middle) * 0.72 + np.array(far) * 0.28) + (6, -24)
        under.fill([high, middle, low, tuple(np.array(low) * 0.3 + np.array(far) * 0.7), tuple(near)], INK)
    shade = under.alpha
    x, y = sheet.grid()
    _tone(sheet, np.where(shade > 0.5, 0.46, 0.0))
    level = np.clip((x - 330) / 420 + (y - 560) / 700, 0, 0.32)
    _tone(sheet, np.where(shade > 0.5, 0, level))
    for low, middle, high in valleys:
        sheet.line([low, middle, high], 6.5, INK, taper=tapered(0.2, 0.8))
        for k in range(9):
            s = 0.06 + 0.07 * k
            a = np.array(low) * (1 - s) + np.array(middle) * s
            sheet.line([a, a + (9, -10), a + (26 - k, -34 + 2 * k)], 2.6, INK, taper=tapered(0.1, 0.9), inside=True)
    for k in range(0, 10, 2):
        a = np.array(HEM[k], float)
        sheet.line(
            [a, a * 0.85 + np.array([262, 380]) * 0.15 + (4, 0), a * 0.66 + np.array([262, 380]) * 0.34],
            3.4,
            INK,
            taper=tapered(0.1, 0.9),
        )
    trim = spline(HEM) - (3, 13)
    sheet.line(trim, 2.4, INK, inside=True, smooth=False)
    for s in np.linspace(0.03, 0.97, 34):
        p = trim[int(s * (len(trim) - 1))]
        sheet.fill([p + (0, -13), p + (4, -8), p + (0, -3), p + (-4, -8)], INK, sharp=True, inside=True)
    sheet.outline(edge, 6, INK)
    return sheet


def figure() -> Sheet:
    """Legs below the cape and the blade beside it, behind the cape."""
    sheet = Sheet("figure", *SIZE)
    blade = np.array([(178, 566), (64, 742), (58, 760), (74, 750), (190, 576)], float)
    sheet.fill(blade, PAPER, sharp=True)
    sheet.outline(np.vstack([spline([a, b]) for a, b in zip(blade, np.roll(blade, -1, axis=0), strict=True)]), 3.4, INK)
    sheet.line([(182, 572), (70, 746)], 2, INK)
    for x in (224, 286):
        leg = [
            (x, 600),
            (x + 44, 600),
            (x + 38, 690),
            (x + 36, 740),
            (x + 44, 752),
            (x - 10, 752),
            (x - 2, 736),
            (x + 4, 690),
        ]
        sheet.fill(leg, INK)
        sheet.line([(x + 9, 664), (x + 8, 738)], 3.5, PAPER, taper=tapered(0.4, 0.4), inside=True)
        sheet.line([(x - 2, 690), (x + 20, 698), (x + 42, 690)], 3, PAPER, inside=True)
    arm = spline(
        [(222, 372), (202, 420), (190, 490), (186, 548), (172, 566), (184, 582), (204, 560), (214, 500), (230, 440)],
        closed=True,
    )
    sheet.fill(arm, INK)
    sheet.line([(200, 440), (194, 500), (188, 548)], 4, PAPER, taper=tapered(0.5, 0.4), inside=True)
    sheet.line([(166, 554), (200, 584)], 8, INK)
    sheet.line([(182, 568), (200, 540)], 9, INK)
    return sheet


def head() -> Sheet:
    """The head, the collar and the shoulder guards, before the cape."""
    sheet = Sheet("head", *SIZE)
    for side, x in ((-1, 214), (1, 308)):
        guard = spline(
            [(x - 34, 376), (x - 30, 348), (x, 334), (x + 30, 346), (x + 34, 374), (x + 4, 390)], closed=True
        )
        sheet.fill(guard, PAPER, sharp=True)
        sheet.fill([(x - 2, 350), (x + 34, 350), (x + 40, 380), (x + 2, 394)], INK, inside=True)
        sheet.line([(x - 26, 366), (x, 356), (x + 28, 364)], 2.4, PAPER if side > 0 else INK, inside=True)
        sheet.outline(guard, 4.5, INK)
    collar = spline(
        [(226, 352), (224, 318), (240, 306), (262, 312), (286, 304), (300, 318), (298, 352), (262, 362)], closed=True
    )
    sheet.fill(collar, PAPER, sharp=True)
    sheet.fill([(262, 306), (302, 304), (304, 356), (266, 362)], INK, inside=True, opacity=1)
    sheet.outline(collar, 4.5, INK)
    sheet.fill([(232, 250), (262, 236), (294, 250), (296, 292), (278, 316), (246, 316), (230, 292)], INK)
    return sheet


def hair() -> Sheet:
    sheet = Sheet("hair", *SIZE, moves=True)
    spikes = [
        ([(246, 246), (262, 206), (300, 190), (340, 196)], 44), ([(256, 250), (290, 216), (330, 216), (378, 236)], 46),
        ([(262, 262), (300, 240), (342, 248), (384, 276)], 46), ([(264, 280), (302, 268), (336, 282), (366, 312)], 42),
        ([(262, 296), (292, 296), (318, 314), (338, 344)], 34), ([(240, 252), (236, 214), (254, 184), (284, 170)], 38),
        ([(246, 296), (256, 316), (274, 330), (292, 350)], 26), ([(236, 270), (222, 244), (226, 214), (240, 196)], 30),
    ]  # fmt: skip
    swell = tapered(0.3, 0.8, 0.03)
    ball = spline([(226, 250), (250, 222), (288, 228), (304, 262), (292, 304), (254, 310), (228, 290)], closed=True)
    sheet.fill(ball, INK)
    for knots, wide in spikes:
        path = spline(knots)
        sheet.line(path, wide + 2, PAPER, taper=swell, smooth=False)
        sheet.line(path, wide, INK, taper=swell, smooth=False)
        shine = path[len(path) // 3 : len(path) * 8 // 10] - (0, wide * 0.18)
        sheet.line(shine, wide * 0.2, PAPER, taper=tapered(0.4, 0.7), smooth=False)
        sheet.line(shine + (2, wide * 0.17), wide * 0.07, PAPER, taper=tapered(0.4, 0.7), smooth=False)
    return sheet


def draw() -> list[Sheet]:
    return [sky(), cliff(), figure(), cape(), head(), hair()]


def finish(picture: Array) -> Array:
    """Grey as a scan of print is, in few levels, so that the file is small."""
    grey = picture.mean(axis=2)
    return np.repeat((np.rint(grey / 17) * 17).astype(np.uint8)[..., None], 3, axis=2)


SCENE = {
    "bodies": [
        {"name": "cape", "layer": 0, "attach": "top", "material": {"preset": "cloth", "sway_frequency": 0.6}},
        {"name": "hair", "layer": 1, "material": {"preset": "hair", "sway_frequency": 1.2}},
    ],
    "rig_points": [
        {"position": [260, 352], "body": 0, "motion": {"type": "pinned"},
         "region": {"type": "polygon", "points": [[170, 300], [340, 300], [346, 400], [190, 420]]}},
        {"position": [262, 268], "body": 1, "motion": {"type": "pinned"}, "region": {"type": "circle", "radius": 44}},
    ],
    "strokes": [
        {"kind": "wind", "path": [[170, 470], [300, 420], [430, 520], [620, 470]], "radius": 150, "speed": 560,
         "strength": 3.4, "interval": 0.9},
        {"kind": "wind", "path": [[170, 620], [300, 570], [430, 670], [640, 600]], "radius": 150, "speed": 500,
         "strength": 3.2, "start": 0.15, "interval": 1.0},
        {"kind": "wind", "path": [[200, 250], [300, 230], [420, 270]], "radius": 100, "speed": 460, "strength": 3.2,
         "start": 0.1, "interval": 0.8},
    ],
}  # fmt: skip
