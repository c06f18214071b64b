"""A fox with a red scarf under a large moon: gouache shapes without lines, with grain and tufts of fur."""

from __future__ import annotations

import numpy as np
from paint import Array, Sheet, mixed, spline, tapered

SIZE = (800, 720)
QUALITY = 90


def night() -> Sheet:
    sheet = Sheet("night", *SIZE)
    sheet.cover(sheet.gradient([(0, "#141a45"), (0.5, "#34407f"), (1, "#8d6fa0")], (0, 0), (0, 640)))
    for _ in range(130):
        x, y, size = sheet.chance.uniform(0, 800), sheet.chance.uniform(0, 430), sheet.chance.uniform(0.5, 1.9)
        _disc(sheet, x, y, size, "#fdf3d0", 0.8, 0.3)
    _disc(sheet, 560, 210, 205, "#f7d99a", 0.25, 40)
    _disc(sheet, 560, 210, 148, "#f8e4b0", 1, 0.6)
    for x, y, size in ((520, 160, 34), (610, 230, 46), (540, 280, 24), (625, 140, 16), (480, 230, 17), (565, 205, 12)):
        _disc(sheet, x, y, size, "#e4c68a", 0.55, 3)
        _disc(sheet, x + 3, y + 3, 0.8 * size, "#efd79f", 0.7, 3)
    for far, base, tone in ((0, 470, "#4c4a86"), (1, 520, "#363a6d")):
        x = np.linspace(-20, 820, 40)
        y = base + 34 * np.sin(x / 97 + 2 * far) + 18 * np.sin(x / 41 + far)
        sheet.fill(np.vstack([np.stack([x, y], 1), [(820, 760), (-20, 760)]]), tone, sharp=True)
        for _ in range(30):
            px = sheet.chance.uniform(0, 800)
            _fir(sheet, px, float(np.interp(px, x, y)) + 8, sheet.chance.uniform(24, 60) * (0.7 + 0.5 * far), tone)
    return sheet


def _disc(sheet: Sheet, x: float, y: float, size: float, colour: str, opacity: float, blur: float) -> None:
    ring = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    sheet.fill(
        np.stack([x + size * np.cos(ring), y + size * np.sin(ring)], 1), colour, sharp=True, opacity=opacity, blur=blur
    )


def _fir(sheet: Sheet, x: float, y: float, tall: float, tone: str) -> None:
    for k in range(4):
        top, wide = y - tall * (1 - 0.2 * k), tall * (0.12 + 0.07 * k)
        sheet.fill(
            [(x, top), (x + wide, top + 0.36 * tall), (x - wide, top + 0.36 * tall)],
            mixed(tone, "#0d1233", 0.1 * k),
            sharp=True,
        )


def hill() -> Sheet:
    sheet = Sheet("hill", *SIZE)
    ground = [(-40, 640), (140, 604), (330, 590), (520, 596), (700, 622), (860, 650), (860, 800), (-60, 800)]
    sheet.fill(ground, sheet.gradient([(0, "#3f5a5c"), (1, "#16263a")], (0, 590), (0, 720)))
    for _ in range(900):
        x = sheet.chance.uniform(-5, 805)
        y = 606 + 0.00028 * (x - 400) ** 2 + sheet.chance.uniform(-6, 110)
        tone = mixed("#5f8a72", "#1a2c3f", min(1, max(0, (y - 600) / 110)) * 0.9)
        lean = sheet.chance.uniform(-7, 9)
        sheet.line([(x, y), (x + lean / 3, y - 9), (x + lean, y - 17)], 2.6, tone, taper=tapered(0, 1))
    return sheet


def _fur(sheet: Sheet, curve: Array, colours: tuple[str, str], long: float, lean: float, share: float = 1.0) -> None:
    """Tufts along an outline, which goes round as the hands of a clock do."""
    along = np.gradient(curve, axis=0)
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    for k in range(0, len(curve), 4):
        if sheet.chance.random() > share:
            continue
        out = np.array([along[k, 1], -along[k, 0]])
        tip = curve[k] + long * sheet.chance.uniform(0.5, 1.15) * (out * 0.7 + along[k] * lean)
        root = curve[k] - out * 5
        sheet.line(
            [root, (root + tip) / 2 + out * 1.5, tip], 7, mixed(*colours, sheet.chance.random()), taper=tapered(0, 1)
        )


def _strokes(sheet: Sheet, spine: Array, wide: float, colour: str, count: int, opacity: float) -> None:
    """Dry brush strokes along a spine, inside what is drawn."""
    for _ in range(count):
        start = int(sheet.chance.integers(0, max(1, len(spine) - 24)))
        piece = spine[start : start + 24 : 6] + sheet.chance.normal(size=2) * wide
        sheet.line(piece, sheet.chance.uniform(1.5, 4), colour, taper=tapered(0.3, 0.6), opacity=opacity, inside=True)


def tail() -> Sheet:
    sheet = Sheet("tail", *SIZE, moves=True)
    spine = spline([(392, 590), (470, 600), (560, 580), (624, 520), (640, 440), (612, 366), (560, 318)])
    t = np.linspace(0, 1, len(spine))
    wide = 46 + 74 * np.sin(np.pi * np.clip(t * 0.92 + 0.05, 0, 1)) ** 1.2
    wide *= np.clip((1 - t) / 0.22, 0.05, 1) ** 0.7
    along = np.gradient(spine, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.stack([-along[:, 1], along[:, 0]], 1) * wide[:, None] / 2
    edge = np.vstack([spine - across, (spine + across)[::-1]])
    _fur(sheet, spine + across, ("#c9551f", "#a33c17"), 17, 1.1)
    _fur(sheet, spine - across, ("#f08a3a", "#d9642a"), -17, -1.1)
    sheet.fill(edge, "#dd6a26", sharp=True)
    sheet.fill(
        np.vstack([spine + 0.05 * across, (spine + 1.05 * across)[::-1]]),
        "#a8401a",
        sharp=True,
        opacity=0.7,
        blur=7,
        inside=True,
    )
    sheet.fill(
        np.vstack([spine - 1.05 * across, (spine - 0.45 * across)[::-1]]),
        "#f7a457",
        sharp=True,
        opacity=0.75,
        blur=5,
        inside=True,
    )
    tip = int(0.74 * len(spine))
    white = np.vstack([(spine - 1.15 * across)[tip:], (spine + 1.15 * across)[tip:][::-1]])
    zigzag = [spine[tip - (10 if k % 2 else -2)] + across[tip] * s for k, s in enumerate(np.linspace(1.1, -1.1, 9))]
    sheet.fill(np.vstack([white, zigzag]), "#fbeedd", sharp=True, inside=True)
    low = np.vstack([(spine + 0.1 * across)[tip:], (spine + 1.1 * across)[tip:][::-1]])
    sheet.fill(low, "#c9a9b4", sharp=True, opacity=0.6, blur=5, inside=True)
    for end in np.linspace(-0.8, 0.8, 9):
        root = spine[-14] + across[-30] * end * 0.7
        aim = spine[-1] + (spine[-1] - spine[-16]) * sheet.chance.uniform(0.3, 0.8) + across[-30] * end * 0.5
        sheet.line([root, aim], 10, "#fbeedd", taper=tapered(0, 1))
    _strokes(sheet, spine[:tip], 16, "#8f3413", 90, 0.35)
    _strokes(sheet, spine[:tip], 16, "#ffc07a", 90, 0.35)
    _strokes(sheet, spine[tip - 10 :], 10, "#cdb3b8", 26, 0.4)
    return sheet


def body() -> Sheet:
    sheet = Sheet("body", *SIZE)
    back = spline(
        [(300, 268), (336, 300), (382, 372), (428, 470), (446, 556), (420, 606), (330, 618), (252, 616), (236, 560), (236, 470), (232, 380), (240, 310)],
        closed=True,
    )  # fmt: skip
    _fur(sheet, back, ("#c9551f", "#b04a1e"), 12, 0.9, 0.8)
    sheet.fill(
        back, sheet.gradient([(0, "#ef8738"), (0.6, "#d4602a"), (1, "#8d351c")], (240, 300), (440, 600)), sharp=True
    )
    sheet.fill(
        [(236, 300), (292, 320), (306, 400), (286, 500), (262, 560), (226, 470), (222, 360)],
        "#fbeedd",
        blur=2.5,
        inside=True,
    )
    sheet.fill(
        [(380, 440), (430, 480), (446, 570), (400, 612), (334, 606), (318, 540), (340, 470)],
        "#c2531f",
        opacity=0.8,
        blur=3,
        inside=True,
    )
    for _ in range(16):
        x, y = 248 + 50 * sheet.chance.random(), 330 + 190 * sheet.chance.random()
        sheet.line(
            [(x, y), (x + 3, y + 14), (x - 2, y + 26)], 4, "#dcbfb4", taper=tapered(0.2, 1), opacity=0.5, inside=True
        )
    spine = spline([(330, 310), (380, 390), (420, 480), (430, 570)])
    _strokes(sheet, spine, 15, "#ffbd78", 70, 0.3)
    _strokes(sheet, spine - (30, -10), 20, "#8f3413", 60, 0.25)
    for dx, tone in ((38, "#7d3018"), (0, "#5b2416")):
        leg = [
            (240 + dx, 440),
            (282 + dx, 440),
            (276 + dx, 540),
            (280 + dx, 606),
            (238 + dx, 614),
            (222 + dx, 606),
            (244 + dx, 590),
            (246 + dx, 520),
        ]
        sheet.fill(
            leg, sheet.gradient([(0, "#e07a30"), (0.45, "#c2531f"), (0.75, tone), (1, "#35182a")], (0, 440), (0, 610))
        )
    sheet.fill([(350, 584), (430, 588), (436, 616), (330, 620)], "#4a2018")
    _head(sheet)
    return sheet


def _head(sheet: Sheet) -> None:
    for ear, inner in (
        ([(284, 166), (322, 92), (344, 176)], [(298, 160), (320, 112), (332, 172)]),
        ([(226, 172), (236, 86), (282, 152)], [(238, 160), (242, 106), (270, 154)]),
    ):
        sheet.fill(ear, "#d4602a", sharp=True)
        sheet.line([ear[0], ear[1], ear[2]], 6, "#5b2416", smooth=False)
        sheet.fill(inner, "#3b1a26", sharp=True)
    head = spline(
        [
            (238, 152),
            (280, 138),
            (326, 156),
            (348, 200),
            (344, 248),
            (312, 276),
            (262, 284),
            (216, 276),
            (168, 270),
            (160, 260),
            (186, 244),
            (210, 208),
        ],
        closed=True,
    )
    _fur(sheet, head[len(head) // 4 : len(head) * 6 // 10], ("#e07a30", "#fbeedd"), 20, 0.5)
    sheet.fill(
        head, sheet.gradient([(0, "#f59a48"), (0.7, "#db6a2b"), (1, "#a8401a")], (220, 140), (340, 280)), sharp=True
    )
    cheek = [(164, 262), (206, 246), (250, 232), (296, 236), (336, 232), (322, 270), (262, 288), (206, 282)]
    sheet.fill(cheek, "#fbeedd", blur=1.5, inside=True)
    sheet.fill([(250, 262), (330, 244), (320, 284), (262, 292)], "#c9a9b4", opacity=0.5, blur=5, inside=True)
    for k in range(9):
        x, y = 318 + 3 * k % 14, 220 + 7 * k
        sheet.line(
            [(x, y), (x + 16, y + 6), (x + 34 - k, y + 16)], 8, ("#fbeedd", "#f3dcc6")[k % 2], taper=tapered(0, 1)
        )
    sheet.fill([(154, 254), (174, 248), (180, 262), (166, 272), (154, 266)], "#23131d")
    sheet.fill([(160, 254), (168, 252), (168, 257), (161, 258)], "#9a8796")
    sheet.line([(170, 272), (196, 278), (222, 274)], 3, "#5b2416", taper=tapered(0.2, 0.6))
    sheet.line([(222, 216), (238, 224), (258, 222), (270, 210)], 6, "#23131d", taper=tapered(0.4, 0.3))
    sheet.line([(268, 212), (278, 202)], 3, "#23131d", taper=tapered(0.1, 0.9))
    for k in range(5):
        y = 262 + 3 * k
        sheet.line(
            [(206, y), (180 - 6 * k, y + 18), (150 - 4 * k, y + 20 + 6 * k)],
            1.3,
            "#f4e6d6",
            taper=tapered(0, 1),
            opacity=0.8,
        )


def scarf() -> Sheet:
    sheet = Sheet("scarf", *SIZE, moves=True)
    for lift, long, tone, shade in ((22, 0.35, "#9c1f35", "#6a1230"), (0, 0.5, "#d0304a", "#8c1838")):
        top = [
            (330, 300 + lift),
            (390, 288 + lift),
            (452, 312 + lift),
            (470 + 60 * long, 300 + lift),
            (490 + 110 * long, 322 + lift * 1.6),
        ]
        low = [
            (484 + 108 * long, 372 + lift * 1.6),
            (462 + 64 * long, 352 + lift),
            (444, 362 + lift),
            (388, 336 + lift),
            (332, 336 + lift),
        ]
        shape = np.vstack([spline(top), spline(low)])
        sheet.fill(shape, tone, sharp=True)
        sheet.fill(
            np.vstack([spline(np.array(low) - (0, 14)), spline(low)[::-1]]),
            shade,
            sharp=True,
            opacity=0.7,
            blur=2,
            inside=True,
        )
        for k in (0, 1):
            p, q = np.array(top[3 + k]), np.array(low[1 - k])
            for off in (0, 13):
                a, b = p - (14 + off - 30 * (1 - k), -2), q - (14 + off - 30 * (1 - k), 2)
                sheet.line([a, b], 5, "#ffd98a", inside=True)
        for s in np.linspace(0.04, 0.96, 9):
            a = np.array(top[-1]) * (1 - s) + np.array(low[0]) * s
            sheet.line([a - (4, 0), a + (14, 2), a + (24, 6)], 4, tone, taper=tapered(0, 0.4))
        sheet.line(
            [(340, 318 + lift), (400, 306 + lift), (456, 334 + lift), (500, 326 + lift)],
            4,
            shade,
            taper=tapered(0.2, 0.8),
            inside=True,
        )
        sheet.line(
            [(350, 308 + lift), (396, 296 + lift), (440, 312 + lift)],
            5,
            "#ff8a8f",
            taper=tapered(0.4, 0.6),
            opacity=0.7,
            inside=True,
        )
    return sheet


def collar() -> Sheet:
    """The scarf around the neck, which lies still on its ends."""
    sheet = Sheet("collar", *SIZE)
    ring = [(226, 282), (262, 290), (320, 276), (350, 268), (362, 300), (344, 330), (290, 350), (244, 342), (226, 316)]
    sheet.fill(ring, sheet.gradient([(0, "#e0455a"), (1, "#8c1838")], (240, 280), (350, 345)))
    for k in range(4):
        sheet.line(
            [(234 + 8 * k, 296 + 10 * k), (290, 312 + 9 * k), (352, 284 + 12 * k)],
            3,
            "#7a1230",
            taper=tapered(0.3, 0.4),
            opacity=0.7,
            inside=True,
        )
    sheet.fill([(318, 286), (350, 280), (362, 312), (344, 338), (318, 326)], "#c22a44")
    sheet.line([(326, 294), (346, 300), (350, 324)], 3, "#7a1230", taper=tapered(0.3, 0.5))
    return sheet


def draw() -> list[Sheet]:
    sheets = [night(), hill(), tail(), scarf(), body(), collar()]
    for sheet in sheets:  # the grain of gouache on paper
        sheet.shaded(1 + 0.022 * sheet.noise(1.0) + 0.03 * sheet.noise(26))
    return sheets


SCENE = {
    "contact": {},
    "bodies": [
        {"name": "tail", "layer": 0, "material": {"preset": "hair", "sway_frequency": 0.8}},
        {"name": "scarf", "layer": 1, "material": {"preset": "cloth", "sway_frequency": 0.9}},
    ],
    "rig_points": [
        {"position": [420, 590], "body": 0, "motion": {"type": "pinned"}, "region": {"type": "circle", "radius": 62}},
        {"position": [346, 312], "body": 1, "motion": {"type": "pinned"}, "region": {"type": "circle", "radius": 38}},
    ],
    "strokes": [
        {"kind": "wind", "path": [[330, 350], [470, 290], [620, 380], [790, 300]], "radius": 140, "speed": 520,
         "strength": 3.5, "interval": 1.0},
        {"kind": "wind", "path": [[480, 600], [600, 450], [760, 420]], "radius": 150, "speed": 420, "strength": 2.9,
         "start": 0.2, "interval": 1.4},
    ],
}  # fmt: skip
