"""A girl in a summer dress on a hill above the sea, seen from behind, in the wind: line art with soft cel shading."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from paint import Array, Sheet, mixed, spline, tapered

SIZE = (720, 900)
INK = "#3a2740"


def background() -> Sheet:
    sheet = Sheet("background", *SIZE)
    sheet.cover(sheet.gradient([(0, "#3d93dc"), (0.45, "#a6dcf4"), (0.66, "#fdf0d8")], (0, 0), (0, 900)))
    _clouds(sheet)
    sheet.fill([(-30, 576), (30, 530), (80, 536), (130, 516), (190, 544), (250, 576)], "#7f9fc4")
    sheet.fill(
        [(-10, 560), (730, 560), (730, 830), (-10, 830)],
        sheet.gradient([(0, "#7cc3de"), (1, "#1f6fae")], (0, 560), (0, 740)),
        sharp=True,
    )
    for _ in range(170):
        x, y = sheet.chance.uniform(0, 720), 562 + 150 * sheet.chance.random() ** 1.6
        wide = 4 + (y - 560) * 0.22 * sheet.chance.random()
        sheet.line(
            [(x - wide, y), (x + wide, y)], 1.2 + (y - 560) / 90, "#eafaff", taper=tapered(0.5, 0.5), opacity=0.75
        )
    for x, size in ((560, 1.0), (640, 0.6)):
        _boat(sheet, x, 600 - 22 * (1 - size), size)
    hill = spline([(-60, 760), (120, 742), (330, 726), (560, 744), (790, 790)])
    sheet.fill(
        np.vstack([hill, [(790, 960), (-60, 960)]]),
        sheet.gradient([(0, "#a6d76c"), (1, "#3f8f4c")], (0, 730), (0, 900)),
        sharp=True,
    )
    for _ in range(700):
        x = sheet.chance.uniform(-5, 725)
        y = float(np.interp(x, hill[:, 0], hill[:, 1])) + 170 * sheet.chance.random() ** 1.3
        long = 8 + (y - 720) * 0.13
        tone = mixed("#cdeb86", "#2f7a45", sheet.chance.random())
        sheet.line(
            [(x, y), (x + 0.35 * long, y - 0.6 * long), (x + long, y - 0.9 * long)], 2.4, tone, taper=tapered(0, 1)
        )
    for _ in range(46):
        x, y = sheet.chance.uniform(0, 720), sheet.chance.uniform(770, 895)
        _flower(sheet, x, y, 2 + (y - 760) / 45)
    return sheet


def _clouds(sheet: Sheet) -> None:
    for x, y, wide, tall in ((600, 470, 210, 250), (90, 520, 190, 130), (380, 545, 190, 70)):
        chance = np.random.default_rng(int(x))
        puffs = []
        for _ in range(46):
            t = chance.random()
            spread = (1 - t) ** 0.55
            puffs.append((x + wide * spread * chance.uniform(-1, 1), y - tall * t, (0.12 + 0.14 * spread) * wide))
        for dx, dy, colour, soft in ((6, 10, "#b9cbe8", 3), (0, 0, "#e6eff9", 1.5), (-8, -10, "#ffffff", 0.8)):
            for px, py, radius in puffs:
                ring = np.linspace(0, 2 * np.pi, 32, endpoint=False)
                r = radius - (5 if dy < 0 else 0)
                sheet.fill(
                    np.stack([px + dx + r * np.cos(ring), py + dy + 0.86 * r * np.sin(ring)], 1),
                    colour,
                    sharp=True,
                    blur=soft,
                )
    for k in range(7):
        x, y = 60 + 90 * k, 70 + 34 * np.sin(2.1 * k)
        sheet.line(
            [(x, y), (x + 80, y - 9), (x + 190, y - 26)], 7, "#ffffff", taper=tapered(0.5, 0.6), opacity=0.5, blur=2
        )


def _boat(sheet: Sheet, x: float, y: float, s: float) -> None:
    sheet.fill(
        [(x - 20 * s, y), (x + 22 * s, y), (x + 14 * s, y + 9 * s), (x - 14 * s, y + 9 * s)], "#8a4b38", sharp=True
    )
    sheet.fill([(x + 1, y - 2), (x + 1, y - 46 * s), (x + 22 * s, y - 6)], "#ffffff", sharp=True)
    sheet.fill([(x - 2, y - 2), (x - 2, y - 40 * s), (x - 17 * s, y - 5)], "#dfe8f4", sharp=True)


def _flower(sheet: Sheet, x: float, y: float, size: float) -> None:
    ring = np.linspace(0, 2 * np.pi, 14, endpoint=False)
    tone = ("#ffffff", "#ffd1dc", "#fff2a8")[int(x) % 3]
    for k in range(5):
        a = 2 * np.pi * k / 5 + x
        sheet.fill(
            np.stack([x + size * (np.cos(a) + 0.7 * np.cos(ring)), y + size * (np.sin(a) + 0.7 * np.sin(ring))], 1),
            tone,
            sharp=True,
        )
    sheet.fill(np.stack([x + 0.7 * size * np.cos(ring), y + 0.7 * size * np.sin(ring)], 1), "#f4b53c", sharp=True)


def _part(
    sheet: Sheet,
    points: list[tuple[float, float]],
    colour: object,
    shade: str,
    shadow: list[tuple[float, float]],
    width: float = 4,
) -> Array:
    edge = spline(points, closed=True)
    sheet.fill(edge, colour, sharp=True)  # type: ignore[arg-type]
    if shadow:
        sheet.fill(shadow, shade, inside=True, blur=0.6)
    sheet.outline(edge, width, INK)
    return edge


def legs() -> Sheet:
    sheet = Sheet("legs", *SIZE)
    skin, shade = "#ffdfc8", "#e8a98f"
    for x, lean in ((286, -6), (334, 8)):
        leg = [
            (x, 590),
            (x + 42, 590),
            (x + 40, 660),
            (x + 36 + lean, 712),
            (x + 30 + lean, 776),
            (x + 8 + lean, 776),
            (x + 2 + lean, 712),
            (x + 2, 660),
        ]
        _part(
            sheet, leg, skin, shade, [(x + 26, 580), (x + 60, 590), (x + 50, 780), (x + 26 + lean, 776), (x + 24, 690)]
        )
        sheet.fill([(x - 6, 580), (x + 50, 580), (x + 50, 640), (x - 6, 628)], shade, inside=True, opacity=0.8)
        shoe = [
            (x + 2 + lean, 764),
            (x + 36 + lean, 764),
            (x + 40 + lean, 792),
            (x + 20 + lean, 800),
            (x - 3 + lean, 792),
        ]
        _part(
            sheet,
            shoe,
            "#c5533f",
            "#8a2f30",
            [(x + 22 + lean, 770), (x + 44 + lean, 774), (x + 40 + lean, 800), (x + 18 + lean, 800)],
        )
    for _ in range(60):
        x, y = sheet.chance.uniform(262, 410), sheet.chance.uniform(792, 808)
        sheet.line(
            [(x, y), (x + 5, y - 16), (x + 14, y - 25)],
            3.4,
            mixed("#b5e077", "#3f8f4c", sheet.chance.random()),
            taper=tapered(0, 1),
        )
    return sheet


def skirt() -> Sheet:
    sheet = Sheet("skirt", *SIZE, moves=True)
    hem = [(250, 640), (280, 668), (322, 654), (362, 684), (410, 660), (452, 684), (498, 646), (548, 652), (590, 612)]
    left = [(282, 448), (270, 500), (256, 566)]
    right = [(540, 560), (466, 506), (396, 470), (362, 446)]
    edge = np.vstack([spline([*left, *hem]), spline([hem[-1], *right])[1:]])
    sheet.fill(
        edge, sheet.gradient([(0, "#ffffff"), (0.6, "#fbf6ff"), (1, "#e3def7")], (300, 450), (470, 690)), sharp=True
    )
    folds = [
        ((304, 452), (286, 560), (280, 668), (322, 654)),
        ((326, 452), (338, 560), (362, 684), (410, 660)),
        ((344, 452), (400, 550), (452, 684), (498, 646)),
        ((356, 450), (460, 540), (548, 652), (590, 612)),
    ]
    for waist, middle, low, high in folds:
        a, b = np.array(low, float), np.array(high, float)
        inner = [waist, middle, tuple(a), tuple(a * 0.25 + b * 0.75), tuple(np.array(middle) * 0.8 + b * 0.2)]
        sheet.fill(inner, "#a9a6dc", opacity=0.75, inside=True, blur=0.7)
    band = np.array(hem, float) - (2, 15)
    sheet.line(band, 5, "#5f86d8", inside=True)
    sheet.line(band - (0, 9), 2, "#5f86d8", inside=True)
    for waist, middle, low, _ in folds:
        sheet.line([waist, middle, low], 3.6, INK, taper=tapered(0.3, 0.25), opacity=0.85)
    for x, y in ((300, 470), (330, 480), (352, 470)):
        sheet.line([(x, y - 18), (x + 6, y + 20), (x + 22, y + 60)], 2.4, INK, taper=tapered(0.1, 1), opacity=0.7)
    sheet.outline(edge, 4.6, INK)
    return sheet


def body() -> Sheet:
    sheet = Sheet("body", *SIZE)
    skin, shade = "#ffdfc8", "#e8a98f"
    arm = [
        (372, 322),
        (394, 340),
        (404, 398),
        (410, 450),
        (424, 508),
        (414, 520),
        (402, 514),
        (388, 458),
        (374, 404),
        (366, 352),
    ]
    _part(sheet, arm, skin, shade, [(392, 350), (410, 380), (420, 520), (404, 520), (396, 440)])
    hand = [(404, 506), (424, 504), (430, 524), (424, 548), (414, 552), (404, 530)]
    _part(sheet, hand, skin, shade, [(418, 510), (434, 520), (424, 552), (416, 540)], 3.4)
    _part(
        sheet,
        [(306, 276), (344, 276), (346, 318), (304, 318)],
        skin,
        shade,
        [(324, 270), (350, 270), (350, 326), (300, 310)],
    )
    bodice = [
        (262, 330),
        (290, 312),
        (324, 318),
        (360, 312),
        (388, 328),
        (378, 390),
        (362, 448),
        (324, 456),
        (282, 450),
        (270, 392),
    ]
    _part(sheet, bodice, "#ffffff", "#b3afe0", [(352, 316), (394, 326), (366, 456), (334, 458), (352, 400)], 4.6)
    sheet.line([(324, 322), (325, 380), (324, 436)], 2.4, INK, taper=tapered(0.2, 0.5), opacity=0.7)
    for x in (290, 352):
        sheet.line([(x, 316), (x + 2, 340), (x + 6, 380)], 2.2, INK, taper=tapered(0.2, 0.9), opacity=0.6)
    sash = [(276, 430), (324, 440), (368, 428), (366, 452), (324, 464), (280, 456)]
    _part(sheet, sash, "#5f86d8", "#3d559f", [(340, 434), (374, 426), (370, 460), (336, 464)])
    up = [
        (262, 342),
        (280, 318),
        (296, 330),
        (274, 300),
        (246, 262),
        (244, 240),
        (262, 216),
        (286, 196),
        (272, 190),
        (250, 204),
        (226, 232),
        (222, 258),
        (238, 300),
        (252, 330),
    ]
    _part(sheet, up, skin, shade, [(226, 240), (222, 262), (250, 320), (268, 330), (244, 280)])
    return sheet


LOCKS = [
    # from back to front: knots of the lock's middle line, widest [px]
    ([(322, 216), (372, 262), (458, 296), (548, 276), (640, 306)], 60),
    ([(318, 240), (352, 318), (440, 380), (530, 376), (626, 418)], 64),
    ([(310, 246), (330, 340), (390, 432), (470, 458), (552, 520)], 62),
    ([(318, 224), (384, 288), (476, 330), (570, 316), (676, 352)], 66),
    ([(306, 246), (318, 340), (352, 420), (410, 470), (462, 548)], 54),
    ([(314, 234), (356, 300), (452, 346), (540, 346), (618, 372)], 60),
    ([(300, 240), (300, 330), (318, 410), (350, 462), (382, 530)], 50),
    ([(308, 240), (334, 318), (404, 398), (486, 416), (570, 468)], 56),
]


OVER = [
    ([(352, 226), (362, 290), (400, 344), (452, 372)], 40),
    ([(334, 226), (338, 300), (366, 372), (414, 430)], 42),
    ([(284, 226), (282, 300), (290, 372), (312, 436)], 36),
    ([(308, 226), (308, 310), (326, 396), (362, 462)], 46),
    ([(368, 226), (384, 280), (430, 318), (490, 330)], 34),
]  # over the seam on the head


def _lock(
    sheet: Sheet, knots: list[tuple[float, float]], wide: float, tone: Array, swell: Callable[[Array], Array]
) -> None:
    path = spline(knots)
    t = np.linspace(0, 1, len(path))
    sheet.line(path, wide + 7, INK, taper=swell, smooth=False)
    sheet.line(path, wide, tone, taper=swell, smooth=False)
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.stack([-along[:, 1], along[:, 0]], 1) * (wide * swell(t))[:, None] / 2
    for side, colour, width, share in (
        (0.52, "#33204f", 0.30, 0.75),
        (-0.42, "#9a72bd", 0.16, 0.8),
        (-0.1, "#7d58a6", 0.10, 0.6),
    ):
        part = slice(len(path) // 7, int(len(path) * (0.94 if side > 0 else 0.72)))
        sheet.line(
            (path + side * across)[part], wide * width, colour, taper=tapered(0.4, 0.6), opacity=share, smooth=False
        )
    for side in (0.24, -0.62):
        part = slice(len(path) // 4, int(len(path) * 0.9))
        sheet.line((path + side * across)[part], 2.6, INK, taper=tapered(0.4, 0.7), opacity=0.8, smooth=False)


def hair() -> Sheet:
    sheet = Sheet("hair", *SIZE, moves=True)
    swell = tapered(0.25, 0.75, 0.02)
    cap = [
        (258, 208),
        (262, 168),
        (318, 150),
        (372, 168),
        (384, 214),
        (384, 262),
        (372, 312),
        (330, 330),
        (284, 316),
        (262, 262),
    ]
    for k, (knots, wide) in enumerate(LOCKS):
        _lock(sheet, knots, wide, mixed("#3f2a5e", "#6a4790", k / 7), swell)
    edge = spline(cap, closed=True)
    sheet.fill(edge, sheet.gradient([(0, "#6a4790"), (1, "#54397a")], (280, 160), (370, 320)), sharp=True)
    for k, x in enumerate((276, 292, 310, 330, 350, 366)):
        sheet.line(
            [(320 + (x - 320) * 0.6, 196), (x, 250), (x + 10 + 5 * k, 318)],
            3,
            INK,
            taper=tapered(0.3, 0.6),
            opacity=0.75,
        )
    shine = [
        (266, 236),
        (292, 250),
        (324, 253),
        (356, 248),
        (382, 232),
        (382, 246),
        (356, 262),
        (324, 268),
        (292, 264),
        (266, 250),
    ]
    sheet.fill(shine, "#c9a4e4", opacity=0.85, blur=0.8)
    for k, (knots, wide) in enumerate(OVER):
        _lock(sheet, knots, wide, mixed("#5f4085", "#6a4790", k / 4), tapered(0.5, 0.7, 0.1))
    sheet.fill(shine, "#c9a4e4", opacity=0.5, blur=0.8)
    sheet.line([(384, 214), (385, 240), (383, 262)], 4.4, INK, taper=tapered(0.1, 0.5))
    sheet.line([(258, 208), (259, 236), (266, 270), (284, 314)], 4.4, INK, taper=tapered(0.1, 0.5))
    return sheet


def ribbon() -> Sheet:
    sheet = Sheet("hat ribbon", *SIZE, moves=True)
    for knots, wide, tone in (
        ([(372, 190), (430, 206), (490, 176), (560, 206), (622, 184)], 26, "#b02c48"),
        ([(372, 184), (424, 176), (480, 196), (540, 160), (590, 148)], 27, "#e0475f"),
    ):
        path = spline(knots)
        t = np.linspace(0, 1, len(path))
        size = wide * (0.45 + 0.55 * np.clip(t * 3, 0, 1)) * (0.8 + 0.2 * np.cos(7 * t))
        along = np.gradient(path, axis=0)
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        across = np.stack([-along[:, 1], along[:, 0]], 1) * size[:, None] / 2
        notch = path[-1] - along[-1] * 16
        edge = np.vstack([path + across, notch[None], (path - across)[::-1]])
        sheet.fill(edge, tone, sharp=True)
        sheet.fill(
            np.vstack([path + across, (path + 0.25 * across)[::-1]]), "#7a1836", sharp=True, opacity=0.6, inside=True
        )
        sheet.line((path - 0.55 * across)[8:-20], 4, "#ff9aa4", taper=tapered(0.3, 0.7), opacity=0.8, smooth=False)
        sheet.outline(edge, 3.8, INK)
    return sheet


def hat() -> Sheet:
    sheet = Sheet("hat", *SIZE)
    straw = sheet.gradient([(0, "#fbe3a0"), (0.6, "#eebf66"), (1, "#b97c3c")], (240, 110), (400, 230))
    brim = spline(
        [
            (196, 214),
            (222, 186),
            (280, 172),
            (350, 172),
            (410, 186),
            (446, 208),
            (432, 224),
            (380, 226),
            (320, 236),
            (256, 234),
            (212, 228),
        ],
        closed=True,
    )
    sheet.fill(brim, straw, sharp=True)
    sheet.fill(
        [(204, 222), (260, 226), (320, 228), (384, 218), (440, 214), (430, 240), (320, 250), (210, 240)],
        "#b0743a",
        opacity=0.75,
        inside=True,
    )
    for k in range(4):
        sheet.line(
            [
                (206 + 6 * k, 214 - 4 * k),
                (260, 192 - 2 * k),
                (330, 186 - 3 * k),
                (400, 196 - 4 * k),
                (436, 212 - 4 * k),
            ],
            1.4,
            "#a8703a",
            opacity=0.6,
            inside=True,
        )
    sheet.outline(brim, 4.6, INK)
    crown = spline(
        [(262, 190), (264, 140), (290, 104), (326, 98), (360, 106), (382, 142), (382, 190), (322, 202)], closed=True
    )
    sheet.fill(crown, straw, sharp=True)
    sheet.fill(
        [(340, 96), (400, 120), (396, 210), (334, 210), (362, 160)], "#b97c3c", opacity=0.65, inside=True, blur=1
    )
    for k in range(8):
        sheet.line(
            [(258, 176 - 10 * k), (322, 186 - 10 * k), (388, 176 - 10 * k)], 1.5, "#a8703a", opacity=0.6, inside=True
        )
    sheet.outline(crown, 4.4, INK)
    band = spline([(262, 168), (322, 180), (382, 168), (382, 190), (322, 203), (262, 190)], closed=True)
    sheet.fill(band, "#e0475f", sharp=True)
    sheet.fill([(344, 168), (386, 160), (386, 196), (340, 206)], "#8f2344", opacity=0.7, inside=True)
    sheet.outline(band, 3.6, INK)
    knot = spline([(366, 168), (388, 166), (392, 200), (368, 202)], closed=True)
    sheet.fill(knot, "#c23350", sharp=True)
    sheet.outline(knot, 3.4, INK)
    hand = [(256, 206), (262, 190), (284, 178), (300, 180), (296, 190), (304, 194), (294, 202), (286, 212), (266, 216)]
    _part(sheet, hand, "#ffdfc8", "#e8a98f", [(262, 212), (280, 206), (300, 194), (300, 214)], 3.6)
    sheet.line([(278, 196), (288, 188), (298, 184)], 2, INK, taper=tapered(0.2, 0.6))
    return sheet


def draw() -> list[Sheet]:
    return [background(), legs(), skirt(), body(), hair(), ribbon(), hat()]


SCENE = {
    "bodies": [
        {"name": "skirt", "layer": 0, "attach": "top", "material": {"preset": "cloth", "sway_frequency": 0.8}},
        {"name": "hair", "layer": 1, "strands": True, "material": {"preset": "hair", "sway_frequency": 0.75}},
        {"name": "hat ribbon", "layer": 2, "attach": "left", "material": {"preset": "ribbon", "sway_frequency": 1.4}},
    ],
    "rig_points": [
        {"position": [318, 250], "body": 1, "motion": {"type": "pinned"},
         "region": {"type": "polygon", "points": [[240, 140], [380, 140], [392, 262], [366, 312], [330, 330], [262, 330]]}},
    ],
    "strokes": [
        {"kind": "wind", "path": [[230, 250], [360, 310], [490, 220], [620, 340], [760, 260]], "radius": 150,
         "speed": 560, "strength": 2.6, "interval": 0.8},
        {"kind": "wind", "path": [[240, 400], [380, 360], [500, 460], [650, 400]], "radius": 150, "speed": 500,
         "strength": 2.2, "start": 0.1, "interval": 1.0},
        {"kind": "wind", "path": [[220, 590], [360, 540], [480, 630], [640, 560]], "radius": 150, "speed": 480,
         "strength": 2.3, "start": 0.2, "interval": 1.1},
        {"kind": "wind", "path": [[340, 170], [440, 210], [540, 150], [680, 190]], "radius": 90, "speed": 480,
         "strength": 2.9, "interval": 0.7},
    ],
}  # fmt: skip
