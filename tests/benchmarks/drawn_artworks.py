"""Layered artworks of four kinds, drawn by a program: an anime bust, a whole figure, soft watercolour, faint things."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
import source_tree  # noqa: F401  (loads this source tree as the package physanimator)
from physanimator.rendering.artwork import ArtLayer, Artwork

__all__ = ["ARTWORKS", "shape"]

SIZE = 480
_FINE = 4
Colour = tuple[int, int, int]


def shape(
    name: str,
    points: list[tuple[float, float]],
    colour: Colour,
    *,
    size: int = SIZE,
    outline: Colour | None = (50, 34, 40),
    lines: int = 0,
    soft: float = 0.0,
    alpha: float = 1.0,
    **layer: object,
) -> ArtLayer:
    """A smooth closed shape through points [px], shaded from top to bottom, cut to where it is.

    Args:
        name: of the layer.
        points: corners, which are rounded.
        colour: of its middle.
        size: of the canvas [px].
        outline: colour of a line of 2 px around it and of the lines in it; None for none.
        lines: how many lines run down in it, as strands or folds do.
        soft: its edge fades over about twice as many pixels.
        alpha: of its middle.
        layer: more of ``ArtLayer``.
    """
    corners = np.array(points, float)
    around = np.linspace(0, len(corners), 40 * len(corners), endpoint=False)
    index, part = around.astype(int), (around % 1)[:, None]
    p = [corners[(index + k) % len(corners)] for k in (-1, 0, 1, 2)]
    curve = p[1] + 0.5 * part * (
        p[2] - p[0] + part * (2 * p[0] - 5 * p[1] + 4 * p[2] - p[3] + part * (3 * (p[1] - p[2]) + p[3] - p[0]))
    )
    fine = np.rint(curve * _FINE * 16).astype(np.int32)
    mask = cv2.fillPoly(np.zeros((size * _FINE,) * 2, np.uint8), [fine], 255, cv2.LINE_AA, 4).astype(np.float32) / 255
    rows, columns = np.mgrid[0 : 1 : 1j * size * _FINE, 0 : 1 : 1j * size * _FINE].astype(np.float32)
    shade = 1.15 - 0.4 * rows + 0.05 * np.sin(60 * columns + 9 * rows)
    paint = np.clip(np.float32(colour) * shade[..., None], 0, 255)
    if outline is not None:
        drawn = np.zeros_like(mask, np.uint8)
        cv2.polylines(drawn, [fine], True, 255, 2 * 2 * _FINE, cv2.LINE_AA, 4)
        (x0, y0), (x1, y1) = corners.min(axis=0), corners.max(axis=0)
        down = np.linspace(0, 1, 50)
        for k in range(1, lines + 1):
            x = x0 + (x1 - x0) * (k / (lines + 1) + 0.05 * np.sin(5 * down + 2 * k))
            line = np.stack([x, y0 + (y1 - y0) * (0.1 + 0.85 * down)], axis=1)
            cv2.polylines(drawn, [np.rint(line * _FINE * 16).astype(np.int32)], False, 200, _FINE, cv2.LINE_AA, 4)
        share = drawn.astype(np.float32)[..., None] / 255
        paint = paint * (1 - share) + np.float32(outline) * share
    if soft:
        mask = cv2.GaussianBlur(mask, (0, 0), soft * _FINE)
        mask *= 0.75 + 0.25 * np.sin(25 * columns + 8 * np.sin(11 * rows))
    planes = np.dstack([paint * mask[..., None], mask * (255 * alpha)])
    planes[..., :3] *= alpha
    planes = cv2.resize(planes, (size, size), interpolation=cv2.INTER_AREA)
    straight = planes[..., :3] * 255 / np.maximum(planes[..., 3:], 1e-3)
    pixels = np.rint(np.clip(np.dstack([straight, planes[..., 3]]), 0, 255)).astype(np.uint8)
    left, top, width, height = cv2.boundingRect((pixels[..., 3] > 0).astype(np.uint8))
    return ArtLayer(name, pixels[top : top + height, left : left + width].copy(), left, top, **layer)  # type: ignore[arg-type]


def _paper(colour: Colour) -> ArtLayer:
    rows, columns = np.mgrid[0:SIZE, 0:SIZE]
    paper = np.float32(colour) + 12 * np.sin(rows / 31)[..., None] + 8 * np.sin(columns / 17)[..., None]
    return ArtLayer("background", np.dstack([np.clip(paper, 0, 255), np.full((SIZE, SIZE), 255)]).astype(np.uint8))


def bust() -> Artwork:
    """Head and shoulders: hair behind, beside and before the face."""
    back = [
        (150, 90),
        (240, 45),
        (330, 90),
        (365, 230),
        (350, 400),
        (300, 380),
        (240, 410),
        (180, 380),
        (130, 400),
        (115, 230),
    ]
    face = [(170, 130), (310, 130), (318, 230), (280, 300), (240, 325), (200, 300), (162, 230)]
    fringe = [
        (155, 190),
        (170, 90),
        (240, 60),
        (310, 90),
        (325, 190),
        (290, 235),
        (270, 170),
        (240, 225),
        (215, 165),
        (185, 230),
    ]
    return Artwork(
        SIZE,
        SIZE,
        (
            _paper((205, 220, 226)),
            shape("back hair", back, (96, 62, 84), lines=7),
            shape("neck", [(212, 290), (268, 290), (276, 390), (204, 390)], (226, 182, 160)),
            shape(
                "topwear",
                [(60, 480), (110, 400), (205, 365), (275, 365), (370, 400), (420, 480)],
                (70, 90, 150),
                lines=3,
            ),
            shape("ears-l", [(150, 200), (172, 190), (176, 240), (160, 250)], (230, 186, 164)),
            shape("ears-r", [(330, 200), (308, 190), (304, 240), (320, 250)], (230, 186, 164)),
            shape("face", face, (240, 204, 184)),
            shape("eyewhite", [(190, 215), (222, 210), (224, 236), (194, 238)], (245, 245, 245)),
            shape("irides", [(266, 212), (284, 212), (286, 238), (266, 238)], (60, 120, 160)),
            shape("mouth", [(225, 280), (255, 280), (240, 288)], (180, 70, 80)),
            shape(
                "side hair-l",
                [(150, 120), (182, 130), (172, 260), (178, 350), (158, 410), (140, 300)],
                (120, 78, 100),
                lines=2,
            ),
            shape(
                "side hair-r",
                [(330, 120), (298, 130), (308, 260), (302, 350), (322, 410), (340, 300)],
                (120, 78, 100),
                lines=2,
            ),
            shape("front hair", fringe, (140, 92, 116), lines=6),
        ),
    )


def figure() -> Artwork:
    """A whole figure with a tail behind, a skirt, an arm in front of it, and a ribbon."""
    skirt = [(200, 235), (280, 235), (330, 360), (290, 352), (262, 372), (232, 354), (196, 372), (150, 356)]
    tail = [(262, 270), (330, 290), (400, 250), (430, 160), (452, 190), (430, 290), (350, 345), (262, 310)]
    return Artwork(
        SIZE,
        SIZE,
        (
            _paper((226, 214, 190)),
            shape("tail", tail, (200, 120, 60), lines=1),
            shape("legwear-l", [(205, 320), (232, 320), (230, 460), (208, 460)], (70, 66, 90)),
            shape("legwear-r", [(250, 320), (276, 320), (274, 460), (252, 460)], (70, 66, 90)),
            shape("skirt", skirt, (170, 60, 76), lines=8),
            shape("topwear", [(195, 140), (285, 140), (280, 250), (200, 250)], (240, 238, 228), lines=2),
            shape("head", [(205, 60), (240, 40), (275, 60), (278, 110), (240, 142), (202, 110)], (242, 206, 186)),
            shape(
                "ribbon",
                [
                    (238, 150),
                    (246, 150),
                    (252, 190),
                    (300, 250),
                    (290, 262),
                    (244, 205),
                    (200, 270),
                    (188, 258),
                    (232, 190),
                ],
                (40, 120, 140),
            ),
            shape(
                "handwear", [(285, 150), (306, 160), (312, 260), (296, 312), (280, 300), (288, 240)], (244, 210, 190)
            ),
        ),
    )


def watercolour() -> Artwork:
    """Translucent paint with soft edges, and a multiplied shade in front of what moves."""
    hair = [(130, 110), (240, 60), (350, 120), (370, 300), (330, 420), (270, 330), (210, 430), (150, 340), (110, 280)]
    return Artwork(
        SIZE,
        SIZE,
        (
            _paper((246, 240, 226)),
            shape(
                "wash", [(40, 60), (440, 40), (450, 430), (50, 450)], (170, 200, 210), outline=None, soft=14, alpha=0.7
            ),
            shape("back hair", hair, (150, 96, 70), outline=None, soft=5, alpha=0.85),
            shape(
                "face",
                [(180, 150), (300, 150), (300, 260), (240, 320), (180, 260)],
                (246, 210, 190),
                outline=None,
                soft=3,
            ),
            shape(
                "blush",
                [(190, 230), (290, 230), (290, 260), (190, 260)],
                (240, 120, 120),
                outline=None,
                soft=8,
                alpha=0.5,
                blend="multiply",
            ),
            shape(
                "scarf",
                [(170, 300), (310, 300), (330, 340), (300, 350), (320, 450), (280, 460), (265, 350), (160, 345)],
                (90, 130, 180),
                outline=None,
                soft=4,
                alpha=0.9,
                opacity=0.85,
            ),
            shape(
                "front hair",
                [(160, 200), (190, 100), (290, 100), (320, 200), (270, 180), (240, 230), (205, 175)],
                (180, 120, 84),
                outline=None,
                soft=4,
                alpha=0.8,
            ),
            shape(
                "shade",
                [(240, 90), (420, 120), (400, 420), (250, 380)],
                (150, 140, 190),
                outline=None,
                soft=10,
                alpha=0.6,
                blend="multiply",
            ),
            shape(
                "light",
                [(100, 90), (200, 80), (190, 260), (110, 250)],
                (120, 110, 70),
                outline=None,
                soft=12,
                alpha=0.6,
                blend="screen",
            ),
        ),
    )


def faint() -> Artwork:
    """Hair with a wide glow, thin wisps that stick out and many specks around it, and a veil that nowhere is dense."""
    hair = shape(
        "hair", [(200, 60), (270, 60), (290, 200), (270, 330), (230, 400), (190, 330), (180, 200)], (250, 200, 90)
    )
    solid = on_canvas(hair)
    glow = cv2.GaussianBlur(cv2.dilate(solid[..., 3], np.ones((31, 31))), (0, 0), 18)
    paint = np.dstack([*(np.full_like(glow, each) for each in (255, 220, 120)), glow * np.float32(0.35)])
    random = np.random.default_rng(1)
    marks = np.zeros((SIZE * _FINE,) * 2, np.uint8)
    for x, y in random.uniform((120, 60), (350, 430), (90, 2)):
        cv2.circle(marks, (int(x * _FINE), int(y * _FINE)), int(random.uniform(1, 2.2) * _FINE), 255, -1, cv2.LINE_AA)
    for k in range(14):
        y = 90 + 22 * k
        side = 190 if k % 2 else 280
        bow = [(side + (1 if side > 240 else -1) * 55 * u, y + 60 * u * u) for u in np.linspace(0, 1, 20)]
        cv2.polylines(marks, [np.int32(np.multiply(bow, _FINE))], False, 255, 4, cv2.LINE_AA)
    share = cv2.resize(marks, (SIZE, SIZE), interpolation=cv2.INTER_AREA).astype(np.float32)
    for over, colour in ((share, (160, 90, 30)), (solid[..., 3], None)):
        alpha = over[..., None] / 255
        top = solid[..., :3] if colour is None else np.float32(colour)
        rest = paint[..., 3:] * (1 - alpha)
        total = np.maximum(rest + 255 * alpha, 1e-3)
        paint = np.dstack([(paint[..., :3] * rest + top * 255 * alpha) / total, rest + 255 * alpha])
    veil = shape(
        "cape", [(300, 150), (420, 170), (440, 400), (380, 440), (320, 380)], (120, 160, 220), lines=3, alpha=0.35
    )
    whole = ArtLayer("hair", np.rint(paint).astype(np.uint8))
    body = shape("topwear", [(190, 380), (290, 380), (310, 480), (170, 480)], (80, 70, 110))
    return Artwork(SIZE, SIZE, (_paper((60, 60, 90)), veil, whole, body))


def on_canvas(layer: ArtLayer) -> np.ndarray:
    """A layer's own pixels over the whole canvas, straight RGBA in 0 to 255, shape [h, w, 4]."""
    canvas = np.zeros((SIZE, SIZE, 4), np.float32)
    left, top, right, bottom = layer.box
    canvas[top:bottom, left:right] = layer.pixels
    return canvas


ARTWORKS: dict[str, Callable[[], Artwork]] = {
    "bust": bust,
    "figure": figure,
    "watercolour": watercolour,
    "faint": faint,
}
