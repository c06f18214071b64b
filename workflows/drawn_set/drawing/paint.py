"""Drawing by program: smooth shapes, tapered lines, washes and shading on layers, three times as fine as the picture."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Sequence
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

FINE = 3
"""How many times as fine as the picture layers are drawn."""

_SHIFT = 4  # bits of a pixel's fraction in OpenCV's drawing
Array = NDArray[Any]
Points = Sequence[Sequence[float]] | Array
Colour = str | Array


def rgb(colour: Colour) -> Array:
    """``#rrggbb`` as float32 in 0..255, shape [3]; arrays as they are."""
    if isinstance(colour, str):
        return np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)], np.float32)
    return np.asarray(colour, np.float32)


def mixed(first: Colour, second: Colour, share: float) -> Array:
    """A colour between two: 0 is the first, 1 the second."""
    return rgb(first) * (1 - share) + rgb(second) * share


def spline(points: Points, *, closed: bool = False, step: float = 2.0) -> Array:
    """A smooth curve through points (Catmull-Rom) [px], shape [n, 2]."""
    p = np.asarray(points, np.float64)
    if len(p) < 3:
        count = max(2, int(np.linalg.norm(p[-1] - p[0]) / step))
        return p[0] + np.linspace(0, 1, count)[:, None] * (p[-1] - p[0])
    p = np.vstack([p[-1:], p, p[:2]]) if closed else np.vstack([2 * p[0] - p[1], p, 2 * p[-1] - p[-2]])
    pieces = []
    for a, b, c, d in zip(p, p[1:], p[2:], p[3:], strict=False):
        t = np.linspace(0, 1, max(3, int(np.linalg.norm(c - b) / step)), endpoint=False)[:, None]
        pieces.append(b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a))))
    return np.vstack([*pieces, p[-2:-1]]) if not closed else np.vstack(pieces)


def tapered(start: float = 0.2, end: float = 0.4, thin: float = 0.08) -> Callable[[Array], Array]:
    """Share of the width along a line: it swells over the first share of the length and thins over the last."""

    def width(t: Array) -> Array:
        rise = np.clip(t / max(start, 1e-6), 0, 1) if start else np.ones_like(t)
        fall = np.clip((1 - t) / max(end, 1e-6), 0, 1) if end else np.ones_like(t)
        return thin + (1 - thin) * np.sin(np.pi / 2 * np.minimum(rise, 1)) * np.sin(np.pi / 2 * np.minimum(fall, 1))

    return width


def sides(path: Array, widths: Array) -> Array:
    """The closed outline of a band along a path of given full widths [px]."""
    along = np.gradient(path, axis=0)
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    across = np.stack([-along[:, 1], along[:, 0]], axis=1) * widths[:, None] / 2
    return np.vstack([path + across, (path - across)[::-1]])


class Sheet:
    """One layer: premultiplied colour and opacity, drawn from back to front."""

    def __init__(self, name: str, width: int, height: int, *, moves: bool = False) -> None:
        self.name, self.width, self.height, self.moves = name, width, height, moves
        self.paint = np.zeros((height * FINE, width * FINE, 3), np.float32)
        self.alpha = np.zeros((height * FINE, width * FINE), np.float32)
        self.chance = np.random.default_rng(zlib.crc32(name.encode()))

    def lay(self, mask: Array, colour: Colour, *, opacity: float = 1.0, inside: bool = False, at: Any = None) -> None:
        """Colour through a mask 0..1; ``inside`` keeps it to what is drawn already."""
        rows, columns = at if at is not None else (slice(None), slice(None))
        own, alpha = rgb(colour), self.alpha[rows, columns]
        own = own[rows, columns] if own.ndim == 3 else own
        share = mask * opacity
        if share.ndim != 2:
            raise ValueError("a mask has two dimensions")
        under = self.paint[rows, columns]
        under *= (1 - share)[..., None]
        under += (share * alpha if inside else share)[..., None] * own
        if not inside:
            alpha += share * (1 - alpha)

    def fill(
        self, points: Points, colour: Colour, *, sharp: bool = False, opacity: float = 1.0, inside: bool = False,
        blur: float = 0.0,
    ) -> None:  # fmt: skip
        """A closed shape, rounded unless ``sharp``; its edge may be blurred [px]."""
        curve = np.asarray(points, float) if sharp else spline(points, closed=True)
        self._draw([curve], colour, opacity, inside, blur)

    def line(
        self, points: Points, width: float, colour: Colour, *, taper: Callable[[Array], Array] | None = None,
        opacity: float = 1.0, inside: bool = False, blur: float = 0.0, smooth: bool = True,
    ) -> None:  # fmt: skip
        """A line whose width [px] may swell and thin along it."""
        path = spline(points) if smooth else np.asarray(points, float)
        t = np.linspace(0, 1, len(path))
        widths = width * (taper(t) if taper is not None else np.ones_like(t))
        along = np.gradient(path, axis=0)
        along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
        across = np.stack([-along[:, 1], along[:, 0]], axis=1) * widths[:, None] / 2
        left, right = path + across, path - across
        quads = np.stack([left[:-1], left[1:], right[1:], right[:-1]], axis=1)
        discs = [(p, w / 2) for p, w in zip(path[::2], widths[::2], strict=True)]
        self._draw(list(quads), colour, opacity, inside, blur, discs)

    def outline(self, points: Points, width: float, colour: Colour, *, closed: bool = True, light: float = 0.6) -> None:
        """A line around a shape, thinner on the side of the light, which comes from the upper left."""
        path = np.asarray(points, float)
        path = np.vstack([path, path[:1]]) if closed else path
        along = np.gradient(path, axis=0)
        along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
        turn = 1.0 if _area(path) > 0 else -1.0
        facing = turn * (along[:, 1] * 0.6 - along[:, 0] * 0.8)  # outward normal against the light
        share = 1 - light * (0.5 - 0.5 * np.clip(facing, -1, 1))
        kernel = np.hanning(15) / np.hanning(15).sum()
        share = np.convolve(np.pad(share, 7, mode="edge"), kernel, "valid")
        self.line(path, width, colour, taper=lambda t: np.interp(t, np.linspace(0, 1, len(share)), share), smooth=False)

    def _draw(
        self, polygons: list[Array], colour: Colour, opacity: float, inside: bool, blur: float, discs: Any = ()
    ) -> None:
        corners = np.vstack([*polygons, *(np.array([c - r, c + r]) for c, r in discs)])
        margin = 3 * blur + 2
        low = np.floor((corners.min(axis=0) - margin) * FINE).astype(int)
        high = np.ceil((corners.max(axis=0) + margin) * FINE).astype(int)
        low, high = np.maximum(low, 0), np.minimum(high, (self.width * FINE, self.height * FINE))
        if (high <= low).any():
            return
        mask = np.zeros((high[1] - low[1], high[0] - low[0]), np.uint8)
        fixed = [np.rint((p * FINE - low) * 2**_SHIFT).astype(np.int32) for p in polygons]
        for each in fixed:
            cv2.fillPoly(mask, [each], 255, cv2.LINE_AA, _SHIFT)
        for centre, radius in discs:
            middle = np.rint((centre * FINE - low) * 2**_SHIFT).astype(int).tolist()
            cv2.circle(mask, middle, max(1, round(radius * FINE * 2**_SHIFT)), 255, -1, cv2.LINE_AA, _SHIFT)
        share = mask.astype(np.float32) / 255
        if blur:
            share = cv2.GaussianBlur(share, (0, 0), blur * FINE)
        at = (slice(low[1], high[1]), slice(low[0], high[0]))
        self.lay(share, colour, opacity=opacity, inside=inside, at=at)

    def grid(self) -> tuple[Array, Array]:
        """x and y of every fine pixel [px], float32."""
        y, x = np.mgrid[0 : self.height * FINE, 0 : self.width * FINE].astype(np.float32)
        return (x + 0.5) / FINE, (y + 0.5) / FINE

    def noise(self, scale: float) -> Array:
        """Smooth noise about 0 of unit spread, of a given grain [px]; finer than a pixel is none."""
        rows, columns = (max(2, int(n / max(scale, 0.5)) + 2) for n in (self.height, self.width))
        field = self.chance.normal(size=(rows, columns)).astype(np.float32)
        field = cv2.resize(field, (self.width * FINE, self.height * FINE), interpolation=cv2.INTER_CUBIC)
        return field / max(float(field.std()), 1e-6)

    def gradient(self, stops: Sequence[tuple[float, Colour]], start: Points, end: Points) -> Array:
        """Colours along the way from one point to another, [h, w, 3]."""
        x, y = self.grid()
        a, b = np.asarray(start, float), np.asarray(end, float)
        t = ((x - a[0]) * (b[0] - a[0]) + (y - a[1]) * (b[1] - a[1])) / max(float(((b - a) ** 2).sum()), 1e-9)
        places = [place for place, _ in stops]
        channels = [np.interp(t, places, [float(rgb(c)[k]) for _, c in stops]) for k in range(3)]
        return np.stack(channels, axis=2).astype(np.float32)

    def cover(self, colour: Colour) -> None:
        """The whole layer in one colour or gradient."""
        self.lay(np.ones_like(self.alpha), colour)

    def shaded(self, factor: Array) -> None:
        """Make all that is drawn lighter or darker."""
        self.paint *= factor[..., None] if factor.ndim == 2 else factor

    def pixels(self) -> Array:
        """Premultiplied RGBA 0..255 and 0..1 at the picture's size, float32 [h, w, 4]."""
        planes = np.dstack([self.paint, self.alpha])
        return cv2.resize(planes, (self.width, self.height), interpolation=cv2.INTER_AREA)


def _area(path: Array) -> float:
    x, y = path[:, 0], path[:, 1]
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())
