"""A part's own alpha made into masks as people and tools make them."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np

__all__ = ["VARIANTS"]

Mask = np.ndarray


def hard(mask: Mask) -> Mask:
    """Black and white."""
    return (mask > 0.5).astype(np.float32)


def blurred(mask: Mask, sigma: float) -> Mask:
    """As a Gaussian filter leaves it [px]."""
    return cv2.GaussianBlur(mask, (0, 0), sigma)


def grown(mask: Mask, radius: int) -> Mask:
    """Grown, or shrunk where the radius is negative [px]."""
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * abs(radius) + 1,) * 2)
    return (cv2.dilate if radius > 0 else cv2.erode)(hard(mask), disc)


def scaled(mask: Mask, factor: int, down: int, up: int) -> Mask:
    """Made smaller and enlarged again."""
    height, width = mask.shape
    small = cv2.resize(mask, (width // factor, height // factor), interpolation=down)
    return np.clip(cv2.resize(small, (width, height), interpolation=up), 0, 1)


def lasso(mask: Mask) -> Mask:
    """Polygons through points that miss the edge by up to six pixels."""
    random, polygons = np.random.default_rng(0), []
    for outline in _outlines(mask):
        points = outline[::28]
        if len(points) > 2:
            polygons.append(np.rint(points + random.uniform(-6, 6, points.shape)).astype(np.int32))
    return cv2.fillPoly(np.zeros(mask.shape, np.float32), polygons, 1)


def brushed(mask: Mask, feather: float) -> Mask:
    """Painted with a round brush that wavers along the edge, with a soft rim [px]."""
    random, painted = np.random.default_rng(0), hard(mask)
    for outline in _outlines(mask):
        for point in outline[::5] + random.normal(0, 2.5, outline[::5].shape):
            cv2.circle(painted, [int(each) for each in np.rint(point)], 4, 1.0, -1)
    return blurred(painted, feather) if feather else painted


def lopsided(mask: Mask) -> Mask:
    """Too wide on the left, too tight on the right."""
    columns = np.nonzero(hard(mask).any(axis=0))[0]
    left = np.arange(mask.shape[1]) < columns.mean()
    return np.where(left, grown(mask, 4), grown(mask, -3))


def compressed(mask: Mask, quality: int) -> Mask:
    """As a JPEG file gives it back."""
    stored = cv2.imencode(".jpg", np.rint(mask * 255).astype(np.uint8), [cv2.IMWRITE_JPEG_QUALITY, quality])[1]
    return cv2.imdecode(stored, cv2.IMREAD_GRAYSCALE).astype(np.float32) / 255


def blocks(mask: Mask, side: int = 256) -> Mask:
    """As a network gives it that sees the picture at 256 px."""
    height, width = mask.shape
    share = side / max(mask.shape)
    small = cv2.resize(mask, (round(width * share), round(height * share)), interpolation=cv2.INTER_AREA)
    return cv2.resize(hard(small), (width, height), interpolation=cv2.INTER_NEAREST)


def _outlines(mask: Mask) -> list[np.ndarray]:
    found, _ = cv2.findContours(hard(mask).astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    return [outline[:, 0] for outline in found]


VARIANTS: dict[str, Callable[[Mask], Mask]] = {
    "own alpha": lambda mask: mask,
    "hard": hard,
    **{f"blurred by {sigma:g}": (lambda mask, sigma=sigma: blurred(mask, sigma)) for sigma in (0.5, 0.7, 1, 2, 4, 8)},
    **{f"grown by {radius}": (lambda mask, radius=radius: grown(mask, radius)) for radius in (1, 2, 4, 8)},
    **{f"shrunk by {radius}": (lambda mask, radius=radius: grown(mask, -radius)) for radius in (1, 2, 4)},
    "half, nearest": lambda mask: scaled(mask, 2, cv2.INTER_NEAREST, cv2.INTER_NEAREST),
    "half, linear": lambda mask: scaled(mask, 2, cv2.INTER_AREA, cv2.INTER_LINEAR),
    "half, Lanczos": lambda mask: scaled(mask, 2, cv2.INTER_AREA, cv2.INTER_LANCZOS4),
    "quarter, nearest": lambda mask: scaled(mask, 4, cv2.INTER_NEAREST, cv2.INTER_NEAREST),
    "quarter, linear": lambda mask: scaled(mask, 4, cv2.INTER_AREA, cv2.INTER_LINEAR),
    "JPEG 60": lambda mask: compressed(mask, 60),
    "blurred, JPEG 20": lambda mask: compressed(blurred(mask, 1), 20),
    "lasso": lasso,
    "brush": lambda mask: brushed(mask, 0),
    "feathered brush": lambda mask: brushed(mask, 4),
    "grown by 4, blurred by 2": lambda mask: blurred(grown(mask, 4), 2),
    "shrunk by 2, blurred by 2": lambda mask: blurred(grown(mask, -2), 2),
    "wide and tight": lopsided,
    "256 px network": blocks,
    "cut off below 0.4": lambda mask: np.where(blurred(mask, 2) < 0.4, np.float32(0), blurred(mask, 2)),
    "at most 0.9": lambda mask: np.float32(0.9) * blurred(mask, 1),
}
