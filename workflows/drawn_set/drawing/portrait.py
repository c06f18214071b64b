"""A painted portrait in profile with hair in the wind: soft shading and loose brush strokes, no lines."""

from __future__ import annotations

import numpy as np
from paint import Array, Sheet, mixed, spline, tapered

SIZE = (820, 720)
QUALITY = 92

FACE = [
    (330, 168), (298, 196), (281, 236), (277, 268), (281, 292), (270, 318), (254, 346), (246, 362), (254, 374), (270, 378),
    (266, 388), (258, 398), (260, 408), (270, 414), (263, 422), (264, 434), (274, 444), (270, 458), (270, 476), (286, 496),
    (322, 500), (372, 474), (414, 436), (446, 380), (450, 280), (400, 190),
]  # fmt: skip


def ground() -> Sheet:
    sheet = Sheet("ground", *SIZE)
    sheet.cover(sheet.gradient([(0, "#d9a67a"), (0.45, "#8a7a86"), (1, "#2b3a4f")], (0, 80), (820, 700)))
    for k in range(520):
        x, y = sheet.chance.uniform(-40, 860), sheet.chance.uniform(-40, 760)
        t = np.clip((x * 0.75 + y * 0.5 - 60) / 820, 0, 1)
        tone = mixed(mixed("#e9bd8c", "#6f7a90", t), "#233247", max(0.0, t * 1.5 - 0.75))
        tone = tone * sheet.chance.uniform(0.86, 1.12)
        angle, long = sheet.chance.normal(-0.5, 0.5), sheet.chance.uniform(40, 110)
        d = long * np.array([np.cos(angle), np.sin(angle)])
        bow = sheet.chance.uniform(-10, 10)
        _bristles(
            sheet, np.array([(x, y), (x + d[0] / 2 - bow, y + d[1] / 2 + bow), (x + d[0], y + d[1])]), 22, tone, 0.5, k
        )
    return sheet


def _bristles(sheet: Sheet, path: Array, wide: float, tone: Array, opacity: float, seed: int) -> None:
    """One stroke of a flat brush: some bristles side by side."""
    chance = np.random.default_rng(seed)
    along = path[-1] - path[0]
    across = np.array([-along[1], along[0]]) / max(float(np.linalg.norm(along)), 1e-6)
    for side in np.linspace(-0.5, 0.5, 5):
        shift = across * wide * side + chance.normal(0, 1.2, 2)
        shade = np.clip(tone * chance.uniform(0.93, 1.07), 0, 255)
        sheet.line(path + shift, wide * 0.36, shade, taper=tapered(0.12, 0.25, 0.3), opacity=opacity, blur=0.5)


def far_hair() -> Sheet:
    """The hair behind the neck."""
    sheet = Sheet("hair", *SIZE, moves=True)
    _mass(sheet, FAR, ("#2a1420", "#4a2028", "#6e2f2c"), 150)
    return sheet


def bust() -> Sheet:
    sheet = Sheet("bust", *SIZE)
    neck = spline(
        [
            (338, 440),
            (344, 520),
            (334, 584),
            (300, 640),
            (300, 740),
            (540, 740),
            (530, 620),
            (476, 560),
            (456, 470),
            (452, 380),
        ],
        closed=True,
    )
    sheet.fill(
        neck,
        sheet.gradient([(0, "#e9b692"), (0.5, "#c98a70"), (1, "#6e3f48")], (320, 560), (500, 600)),
        sharp=True,
        blur=0.8,
    )
    sheet.fill(
        [(330, 470), (400, 470), (452, 420), (470, 520), (420, 540), (350, 530)],
        "#7c3f46",
        opacity=0.6,
        blur=14,
        inside=True,
    )
    sheet.line(
        [(372, 500), (366, 570), (340, 632)], 12, "#f6cfae", taper=tapered(0.4, 0.5), opacity=0.5, blur=5, inside=True
    )
    dress = spline(
        [
            (180, 760),
            (196, 690),
            (250, 648),
            (316, 620),
            (372, 664),
            (440, 650),
            (500, 600),
            (590, 640),
            (660, 700),
            (690, 760),
        ],
        closed=True,
    )
    sheet.fill(
        dress,
        sheet.gradient([(0, "#3f7f86"), (0.5, "#245260"), (1, "#122838")], (220, 640), (640, 720)),
        sharp=True,
        blur=1,
    )
    for _ in range(150):
        x = sheet.chance.uniform(200, 660)
        y = 640 + 90 * sheet.chance.random() + 0.0012 * (x - 420) ** 2 * 0.6
        d = np.array([sheet.chance.uniform(14, 44), sheet.chance.uniform(10, 40)])
        tone = mixed(
            mixed("#62a8a6", "#2f6671", (x - 200) / 300 if x < 500 else 1.0), "#0f2332", sheet.chance.random() * 0.6
        )
        sheet.line(
            [(x, y), (x + d[0] / 2, y + d[1] * 0.4), tuple((x, y) + d)],
            9,
            tone,
            taper=tapered(0.2, 0.4),
            opacity=0.45,
            blur=0.6,
            inside=True,
        )
    _face(sheet)
    return sheet


def _face(sheet: Sheet) -> None:
    face = spline(FACE, closed=True, step=1)
    skin = sheet.gradient([(0, "#ffe3c4"), (0.4, "#f3bd98"), (0.75, "#cf8a72"), (1, "#8d5054")], (246, 320), (452, 400))
    sheet.fill(face, skin, sharp=True, blur=0.5)
    soft = {"inside": True}
    sheet.fill(
        [(330, 470), (400, 420), (450, 330), (470, 420), (400, 500), (320, 516)],
        "#8a4a50",
        opacity=0.55,
        blur=16,
        **soft,
    )  # type: ignore[arg-type]
    sheet.fill([(296, 366), (336, 352), (362, 384), (330, 414), (298, 402)], "#e8775f", opacity=0.42, blur=16, **soft)  # type: ignore[arg-type]
    sheet.fill([(284, 290), (310, 286), (340, 300), (316, 322), (288, 318)], "#a85f5a", opacity=0.45, blur=8, **soft)  # type: ignore[arg-type]
    sheet.fill([(258, 370), (276, 366), (284, 376), (272, 386), (258, 380)], "#b0605a", opacity=0.5, blur=4, **soft)  # type: ignore[arg-type]
    sheet.line(
        [(280, 296), (268, 324), (254, 352)], 9, "#fff3df", taper=tapered(0.4, 0.4), opacity=0.7, blur=3, inside=True
    )
    sheet.fill([(286, 200), (318, 186), (326, 230), (300, 262), (282, 250)], "#fff0d8", opacity=0.55, blur=12, **soft)  # type: ignore[arg-type]
    sheet.fill([(278, 462), (300, 468), (296, 488), (276, 482)], "#ffe9d0", opacity=0.5, blur=6, **soft)  # type: ignore[arg-type]
    sheet.fill([(255, 399), (272, 396), (292, 408), (284, 414), (264, 412)], "#b8443f", opacity=0.9, blur=1.2, **soft)  # type: ignore[arg-type]
    sheet.fill([(262, 416), (286, 415), (290, 420), (276, 434), (262, 430)], "#d8635a", opacity=0.9, blur=1.4, **soft)  # type: ignore[arg-type]
    sheet.line(
        [(262, 413), (276, 414), (296, 411)], 3, "#6a2430", taper=tapered(0.3, 0.5), opacity=0.9, blur=0.6, inside=True
    )
    sheet.fill([(266, 422), (276, 421), (272, 427)], "#ffb9a6", opacity=0.8, blur=1.2, **soft)  # type: ignore[arg-type]
    # the closed eye and its brow
    sheet.line(
        [(290, 306), (300, 316), (318, 318), (336, 308)],
        5.5,
        "#33161f",
        taper=tapered(0.35, 0.35),
        opacity=0.95,
        blur=0.4,
    )
    for x, y, dx, dy in (
        (292, 309, -13, 7),
        (298, 314, -11, 11),
        (306, 317, -7, 13),
        (315, 318, -2, 13),
        (324, 315, 4, 12),
    ):
        sheet.line(
            [(x, y), (x + 0.6 * dx, y + 0.7 * dy), (x + dx, y + dy)],
            2.0,
            "#33161f",
            taper=tapered(0, 1),
            opacity=0.9,
            blur=0.3,
        )
    sheet.line(
        [(288, 300), (306, 296), (328, 298), (342, 306)], 3, "#8a4a4c", taper=tapered(0.4, 0.5), opacity=0.7, blur=0.8
    )
    sheet.line(
        [(284, 268), (304, 256), (330, 258), (352, 270)], 8, "#4a2028", taper=tapered(0.25, 0.7), opacity=0.85, blur=1
    )
    sheet.fill([(264, 372), (272, 369), (276, 374), (268, 377)], "#6a2c34", opacity=0.8, blur=1.2, **soft)  # type: ignore[arg-type]
    _ear(sheet)
    for _ in range(90):
        x, y = sheet.chance.uniform(290, 440), sheet.chance.uniform(200, 480)
        tone = mixed("#ffe0c0", "#a85f5a", np.clip((x - 280) / 170 + 0.1 * sheet.chance.normal(), 0, 1))
        sheet.line(
            [(x, y), (x + 8, y + 14), (x + 10, y + 30)],
            9,
            tone,
            taper=tapered(0.3, 0.5),
            opacity=0.16,
            blur=1.5,
            inside=True,
        )


def _ear(sheet: Sheet) -> None:
    ear = [(414, 300), (436, 296), (446, 318), (438, 346), (424, 366), (412, 356), (410, 326)]
    sheet.fill(ear, "#d98f76", blur=1)
    sheet.line(
        [(418, 310), (434, 306), (438, 324), (430, 344)], 4, "#8d4548", taper=tapered(0.3, 0.5), opacity=0.8, blur=1
    )
    sheet.fill([(420, 366), (426, 372), (422, 384), (415, 380), (415, 370)], "#5fb0a8", blur=0.5)
    sheet.fill([(417, 371), (420, 370), (419, 374)], "#e8fff8", blur=0.4)


FAR = [
    [(410, 300), (470, 400), (560, 470), (660, 470), (780, 540)],
    [(420, 330), (470, 450), (540, 540), (630, 560), (730, 640)],
    [(430, 340), (452, 460), (500, 560), (570, 610), (640, 690)],
]
NEAR = [
    # from the front of the hairline to its back: root to tip
    [(326, 168), (358, 108), (444, 94), (560, 150), (676, 128), (796, 170)],
    [(322, 172), (352, 120), (440, 112), (560, 178), (676, 168), (800, 236)],
    [(318, 180), (372, 140), (468, 156), (570, 232), (680, 230), (806, 318)],
    [(314, 190), (380, 170), (470, 214), (562, 296), (668, 306), (780, 400)],
    [(330, 186), (392, 200), (452, 268), (540, 356), (640, 376), (742, 474)],
    [(340, 190), (396, 226), (436, 306), (500, 408), (590, 452), (676, 560)],
    [(352, 196), (398, 250), (424, 340), (468, 450), (536, 520), (596, 626)],
]


def hair() -> Sheet:
    """The hair in front, combed back over the ear."""
    sheet = Sheet("hair", *SIZE, moves=True)
    crown = [
        (312, 190),
        (326, 146),
        (372, 108),
        (440, 102),
        (510, 134),
        (548, 190),
        (540, 280),
        (500, 340),
        (452, 372),
        (420, 330),
        (404, 262),
        (368, 216),
    ]
    sheet.fill(crown, "#542430", blur=2)
    _mass(sheet, NEAR, ("#3f1a24", "#86392f", "#c9703f"), 420)
    for knots in ([(318, 182), (300, 214), (300, 262), (316, 300)], [(326, 178), (290, 206), (276, 250), (262, 280)]):
        for k in range(7):
            path = spline(knots) + sheet.chance.normal(0, 2.2, 2)
            sheet.line(
                path,
                3.6,
                mixed("#542430", "#c9703f", k / 7),
                taper=tapered(0.15, 0.9),
                opacity=0.85,
                blur=0.4,
                smooth=False,
            )
    return sheet


def _mass(sheet: Sheet, guides: list[list[tuple[float, float]]], tones: tuple[str, str, str], strands: int) -> None:
    """Hair between guide curves: a soft dark mass, strands of many tones, and light where it turns up to it."""
    count = 60
    curves = [spline(g)[np.linspace(0, len(spline(g)) - 1, count).astype(int)] for g in guides]
    stack = np.array(curves)
    t = np.linspace(0, 1, count)
    for share in np.linspace(0, 1, 30):
        path = _clumped(stack, share * (len(curves) - 1), 0.8)[: int(count * sheet.chance.uniform(0.72, 0.9))]
        sheet.line(path, 36, tones[0], taper=tapered(0.05, 0.8, 0.05), opacity=0.9, blur=1.6, smooth=False)
    for k in range(strands):
        where = sheet.chance.uniform(0, len(curves) - 1)
        path = _clumped(stack, where, sheet.chance.uniform(0.5, 1.05))
        ahead = 1 - 0.42 * sheet.chance.random()
        begin = 0 if sheet.chance.random() < 0.4 else int(sheet.chance.uniform(0, 25))
        part = path[begin : max(begin + 14, int(count * ahead))]
        along = t[: len(part)]
        wander = np.stack([sheet.chance.normal(0, 9) * along, sheet.chance.normal(0, 9) * along], 1)
        lit = 0.5 + 0.42 * np.sin(2.2 * where + 1.3) + 0.25 * sheet.chance.normal() - 0.12 * k / strands
        tone = _toned(tones, float(np.clip(lit, 0, 1)))
        wide = sheet.chance.uniform(2, 8) * (1 - 0.4 * k / strands)
        sheet.line(part + wander, wide, tone, taper=tapered(0.25, 0.75, 0.04), opacity=0.72, blur=0.5, smooth=False)
    for _ in range(strands // 9):
        path = _clumped(stack, sheet.chance.uniform(0, len(curves) - 1), 0.8)
        begin = int(sheet.chance.uniform(5, 22))
        part = path[begin : begin + 16] + sheet.chance.normal(0, 3, 2)
        gleam = mixed(tones[2], "#ffe0b0", 0.55)
        sheet.line(part, 3.2, gleam, taper=tapered(0.5, 0.5), opacity=0.5, blur=0.7, smooth=False)


def _toned(tones: tuple[str, str, str], lit: float) -> Array:
    return mixed(tones[0], tones[1], 2 * lit) if lit < 0.5 else mixed(tones[1], tones[2], 2 * lit - 1)


def _clumped(stack: Array, where: float, pull: float) -> Array:
    """A strand between guides that joins others towards its tip."""
    t = np.linspace(0, 1, stack.shape[1])
    aim = np.clip((np.floor(where / 0.55) + 0.5) * 0.55 + 0.1 * np.sin(9 * where), 0, len(stack) - 1)
    places = where + (aim - where) * pull * t**1.4
    first = np.minimum(places.astype(int), len(stack) - 2)
    share = (places - first)[:, None]
    steps = np.arange(stack.shape[1])
    return stack[first, steps] * (1 - share) + stack[first + 1, steps] * share


def draw() -> list[Sheet]:
    sheets = [ground(), far_hair(), bust(), hair()]
    for sheet in sheets:  # canvas
        x, y = sheet.grid()
        sheet.shaded(1 + 0.014 * np.sin(2.2 * x) + 0.014 * np.sin(2.2 * y) + 0.012 * sheet.noise(1.2))
    return sheets


SCENE = {
    "bodies": [{"name": "hair", "material": {"preset": "hair", "sway_frequency": 0.75}}],
    "rig_points": [
        {"position": [400, 200], "body": 0, "motion": {"type": "pinned"},
         "region": {"type": "polygon", "points": [[240, 60], [500, 60], [560, 190], [520, 330], [490, 440], [500, 560], [440, 560], [400, 400], [240, 320]]}},
    ],
    "strokes": [
        {"kind": "wind", "path": [[400, 170], [520, 110], [650, 260], [820, 200]], "radius": 150, "speed": 600,
         "strength": 2.3, "interval": 0.9},
        {"kind": "wind", "path": [[430, 380], [540, 300], [660, 430], [820, 360]], "radius": 150, "speed": 540,
         "strength": 2.2, "start": 0.15, "interval": 1.0},
        {"kind": "wind", "path": [[430, 540], [540, 480], [640, 600], [800, 540]], "radius": 150, "speed": 500,
         "strength": 2.1, "start": 0.3, "interval": 1.2},
    ],
}  # fmt: skip
