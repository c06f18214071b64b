"""Pictures without outlines, drawn by a program: paint, watercolour, coloured pencil, airbrush; and damage to pictures.

Each picture shows one part (a head of hair, a wing or a skirt) before other things, with the part's true mask.
"""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["DAMAGES", "PARTS", "TECHNIQUES", "painted", "points_in"]

Picture = NDArray[np.uint8]
Mask = NDArray[np.bool_]

_COLOURS = {"hair": (116, 62, 38), "wing": (214, 186, 120), "skirt": (70, 104, 160)}
_SCENERY = ((150, 170, 140), (188, 148, 116), (60, 76, 70), (214, 206, 196), (120, 120, 160))
PARTS = tuple(_COLOURS)


def painted(technique: str, part: str, *, width: int = 320, height: int = 240, seed: int = 0) -> tuple[Picture, Mask]:
    """The picture, uint8 [h, w, 3], and the part's mask, bool [h, w]."""
    generator = np.random.default_rng(seed)
    truth = _shape(part, width, height, generator)
    layers = [(np.ones((height, width), bool), _SCENERY[generator.integers(len(_SCENERY))])]
    for _ in range(4):
        blob = _blob(width, height, generator)
        layers.append((blob, _SCENERY[generator.integers(len(_SCENERY))]))
    layers.append((truth, _COLOURS[part]))
    picture = TECHNIQUES[technique](layers, generator)
    return np.rint(np.clip(picture, 0, 255)).astype(np.uint8), truth


def points_in(truth: Mask, on: int, beside: int, *, seed: int = 0) -> NDArray[np.float64]:
    """Random clicks of a careful hand: x, y and label, shape [on + beside, 3]."""
    generator = np.random.default_rng(seed)
    rows = []
    for mask, count, label in ((truth, on, 1), (_around(truth), beside, 0)):
        depth = cv2.distanceTransform(np.pad(mask, 1).astype(np.uint8), cv2.DIST_L2, 5)[1:-1, 1:-1]
        places = np.argwhere(depth >= min(4.0, 0.5 * float(depth.max())))
        for row, column in places[generator.integers(len(places), size=count)] if len(places) else ():
            rows.append((column + 0.5, row + 0.5, label))
    return np.array(rows, dtype=float)


def _around(truth: Mask) -> Mask:
    left, top, columns, rows = cv2.boundingRect(truth.astype(np.uint8))
    window = np.zeros_like(truth)
    x, y = columns // 4, rows // 4
    window[max(0, top - y) : top + rows + y, max(0, left - x) : left + columns + x] = True
    return window & ~truth


def _shape(part: str, width: int, height: int, generator: np.random.Generator) -> Mask:
    mask = np.zeros((height, width), np.uint8)
    centre = np.array([width * generator.uniform(0.42, 0.58), height * 0.5])
    if part == "hair":
        for strand in np.linspace(-1, 1, 9):
            down = np.linspace(0, 1, 24)
            x = centre[0] + width * (0.13 * strand + 0.05 * strand * down + 0.02 * np.sin(5 * down + 3 * strand))
            y = height * (0.15 + 0.1 * strand**2 + (0.62 - 0.1 * abs(strand)) * down)
            line = np.stack([x, y], axis=1)
            cv2.polylines(mask, [np.rint(line).astype(np.int32)], False, 1, max(3, round(0.045 * width)))
    elif part == "wing":
        for feather in np.linspace(0.1, 1.3, 9):
            tip = centre + np.array([np.cos(feather), -np.sin(feather)]) * width * 0.33
            axes = (round(0.17 * width), round(0.035 * width))
            middle = np.rint((tip + centre) / 2).astype(int).tolist()
            cv2.ellipse(mask, middle, axes, -np.degrees(feather), 0, 360, 1, -1)
    else:
        corners = np.array([[-0.08, -0.3], [0.08, -0.3], [0.26, 0.36], [0.1, 0.3], [-0.05, 0.38], [-0.24, 0.33]])
        cv2.fillPoly(mask, [np.rint(centre + corners * (width * 0.9, height)).astype(np.int32)], 1)
    return mask > 0


def _blob(width: int, height: int, generator: np.random.Generator) -> Mask:
    field = cv2.GaussianBlur(generator.normal(size=(height, width)).astype(np.float32), (0, 0), width / 14)
    return field > np.quantile(field, generator.uniform(0.6, 0.85))


def _shading(shape: tuple[int, int], generator: np.random.Generator, depth: float) -> NDArray[np.float32]:
    """Slow light and shade around 1."""
    field = cv2.GaussianBlur(generator.normal(size=shape).astype(np.float32), (0, 0), shape[1] / 8)
    return (1 + depth * field / max(float(np.abs(field).max()), 1e-9))[..., None]


def _grain(shape: tuple[int, int], generator: np.random.Generator, sigma: float) -> NDArray[np.float32]:
    """Paper grain around 0, of unit spread."""
    field = generator.normal(size=shape).astype(np.float32)
    field = cv2.GaussianBlur(field, (0, 0), sigma) if sigma > 0 else field
    return (field / field.std())[..., None]


def _brush(layers: list[tuple[Mask, tuple[int, int, int]]], generator: np.random.Generator) -> NDArray[np.float32]:
    """Short opaque strokes of uneven colour, on canvas."""
    height, width = layers[0][0].shape
    picture = np.zeros((height, width, 3), np.float32)
    length, breadth = width / 24, max(2, round(width / 110))
    for mask, colour in layers:
        angles = cv2.GaussianBlur(generator.normal(size=(height, width)).astype(np.float32), (0, 0), width / 12)
        angles *= 2 / max(float(angles.std()), 1e-9)
        own = (np.array(colour) * _shading((height, width), generator, 0.25)).astype(np.float32)
        canvas, places = picture.copy(), np.argwhere(mask)
        for row, column in places[generator.integers(len(places), size=6 * len(places) // round(length * breadth))]:
            step = length / 2 * np.array([np.cos(angles[row, column]), np.sin(angles[row, column])])
            ends = [tuple(np.rint((column, row) + sign * step).astype(int).tolist()) for sign in (-1, 1)]
            cv2.line(canvas, *ends, (own[row, column] * generator.uniform(0.86, 1.14)).tolist(), breadth, cv2.LINE_AA)
        inside = cv2.dilate(mask.astype(np.uint8), np.ones((breadth, breadth), np.uint8)) > 0
        unpainted = mask & (canvas == picture).all(axis=2)
        canvas[unpainted] = own[unpainted]
        picture = np.where(inside[..., None], canvas, picture)
    rows, columns = np.mgrid[:height, :width]
    weave = (np.sin(columns * 1.9) + np.sin(rows * 1.9))[..., None]
    return cv2.GaussianBlur(picture, (0, 0), 0.7) * (1 + 0.03 * weave) + 4 * _grain((height, width), generator, 0.6)


def _watercolour(
    layers: list[tuple[Mask, tuple[int, int, int]]], generator: np.random.Generator
) -> NDArray[np.float32]:
    """Washes that bleed into each other, darker along their edges, on granular paper."""
    height, width = layers[0][0].shape
    picture = np.full((height, width, 3), 244, np.float32)
    for mask, colour in layers:
        soft = cv2.GaussianBlur(mask.astype(np.float32), (0, 0), width / 200)
        wash = (0.62 + 0.3 * (_shading((height, width), generator, 1.0)[..., 0] - 1)) * soft
        wash += 0.25 * soft * (1 - cv2.GaussianBlur(mask.astype(np.float32), (0, 0), width / 60))
        wash *= 1 + 0.1 * _grain((height, width), generator, 1.0)[..., 0]
        share = np.clip(wash, 0, 1)[..., None]
        picture = picture * (1 - soft[..., None] * 0.85) + 244 * soft[..., None] * 0.85 if mask.all() else picture
        picture = picture * (1 - share) + np.array(colour) * share
    return picture + 3 * _grain((height, width), generator, 0.8)


def _pencil(layers: list[tuple[Mask, tuple[int, int, int]]], generator: np.random.Generator) -> NDArray[np.float32]:
    """Hatching that lets the paper through."""
    height, width = layers[0][0].shape
    picture = np.full((height, width, 3), 240, np.float32)
    rows, columns = np.mgrid[:height, :width].astype(np.float32)
    for mask, colour in layers:
        angle = generator.uniform(0, np.pi)
        along = np.cos(angle) * columns + np.sin(angle) * rows
        hatch = 0.75 + 0.25 * np.sin(along * 1.6 + 1.5 * _grain((height, width), generator, 5)[..., 0])
        tooth = np.clip(hatch + 0.22 * _grain((height, width), generator, 0.8)[..., 0], 0.15, 1)
        share = (cv2.GaussianBlur(mask.astype(np.float32), (0, 0), 0.8) * tooth)[..., None]
        picture = picture * (1 - share) + np.array(colour) * _shading((height, width), generator, 0.2) * share
    return picture


def _airbrush(layers: list[tuple[Mask, tuple[int, int, int]]], generator: np.random.Generator) -> NDArray[np.float32]:
    """Strong soft shading, soft edges, fine grain."""
    height, width = layers[0][0].shape
    picture = np.zeros((height, width, 3), np.float32)
    for mask, colour in layers:
        share = cv2.GaussianBlur(mask.astype(np.float32), (0, 0), width / 250)[..., None]
        picture = picture * (1 - share) + np.array(colour) * _shading((height, width), generator, 0.45) * share
    return picture + 2.5 * _grain((height, width), generator, 0)


TECHNIQUES: dict[str, Callable[..., NDArray[np.float32]]] = {
    "brush": _brush,
    "watercolour": _watercolour,
    "pencil": _pencil,
    "airbrush": _airbrush,
}


def _noisy(picture: Picture, truth: Mask) -> tuple[Picture, Mask]:
    noise = np.random.default_rng(1).normal(0, 12, picture.shape)
    return np.clip(picture + noise, 0, 255).astype(np.uint8), truth


def _jpeg(quality: int) -> Callable[[Picture, Mask], tuple[Picture, Mask]]:
    def damaged(picture: Picture, truth: Mask) -> tuple[Picture, Mask]:
        _, data = cv2.imencode(".jpg", picture[..., ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])
        return np.ascontiguousarray(cv2.imdecode(data, cv2.IMREAD_COLOR)[..., ::-1]), truth

    return damaged


def _photo(picture: Picture, truth: Mask) -> tuple[Picture, Mask]:
    """Lens blur, uneven light, sensor noise, JPEG."""
    generator = np.random.default_rng(2)
    light = np.linspace(0.7, 1.1, picture.shape[1])[None, :, None] * np.linspace(1.05, 0.9, len(picture))[:, None, None]
    seen = cv2.GaussianBlur(picture, (0, 0), max(1.0, picture.shape[1] / 800)) * light
    seen += generator.normal(0, 6, seen.shape)
    return _jpeg(80)(np.clip(seen, 0, 255).astype(np.uint8), truth)


def _repainted(picture: Picture, truth: Mask) -> tuple[Picture, Mask]:
    """Small touches of uneven colour in place of the picture's own detail, on canvas."""
    generator = np.random.default_rng(3)
    height, width = truth.shape
    smooth = cv2.medianBlur(picture, 7)
    canvas, breadth = smooth.astype(np.float32), max(2, width // 300)
    rows, columns = generator.integers(height, size=width * 12), generator.integers(width, size=width * 12)
    for row, column in zip(rows, columns, strict=True):
        angle = 6.0 * row / height + 5.0 * column / width
        step = 2 * breadth * np.array([np.cos(angle), np.sin(angle)])
        ends = [tuple(np.rint((column, row) + sign * step).astype(int).tolist()) for sign in (-1, 1)]
        colour = smooth[row, column] * generator.uniform(0.85, 1.15)
        cv2.line(canvas, *ends, colour.tolist(), breadth, cv2.LINE_AA)
    weave = np.sin(np.arange(width) * 1.9)[None, :, None] + np.sin(np.arange(height) * 1.9)[:, None, None]
    return np.clip(canvas * (1 + 0.03 * weave), 0, 255).astype(np.uint8), truth


def _scaled(factor: float, how: int) -> Callable[[Picture, Mask], tuple[Picture, Mask]]:
    def scaled(picture: Picture, truth: Mask) -> tuple[Picture, Mask]:
        size = (round(truth.shape[1] * factor), round(truth.shape[0] * factor))
        return cv2.resize(picture, size, interpolation=how), cv2.resize(truth.astype(np.float32), size) > 0.5

    return scaled


def _posterised(picture: Picture, truth: Mask) -> tuple[Picture, Mask]:
    return (picture // 51 * 51 + 25).astype(np.uint8), truth


def _pixel_art(picture: Picture, truth: Mask) -> tuple[Picture, Mask]:
    small, mask = _scaled(160 / truth.shape[1], cv2.INTER_AREA)(picture, truth)
    return _posterised(small, mask)


DAMAGES: dict[str, Callable[[Picture, Mask], tuple[Picture, Mask]]] = {
    "clean": lambda picture, truth: (picture, truth),
    "repainted": _repainted,
    "noisy": _noisy,
    "photo": _photo,
    "jpeg20": _jpeg(20),
    "jpeg40": _jpeg(40),
    "twice": _scaled(2, cv2.INTER_CUBIC),
    "quarter": _scaled(0.25, cv2.INTER_AREA),
    "posterised": _posterised,
    "pixel_art": _pixel_art,
}
