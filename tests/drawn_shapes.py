"""Shapes drawn with edges as soft as a pixel, over grounds with a grain."""

from __future__ import annotations

import cv2
import numpy as np

FINE = 4
"""Shapes are drawn so many times as large."""


def coverage(fine: np.ndarray) -> np.ndarray:
    """How much of each pixel a fine shape covers, 0 to 1, shape [h, w] of [FINE h, FINE w]."""
    height, width = fine.shape
    return cv2.resize(fine.astype(np.float32), (width // FINE, height // FINE), interpolation=cv2.INTER_AREA)


def filled(size: tuple[int, int], *polygons: list[tuple[float, float]]) -> np.ndarray:
    """Polygons [px] as one fine shape of a picture of a size [h, w]."""
    fine = np.zeros((size[0] * FINE, size[1] * FINE), np.uint8)
    for points in polygons:
        cv2.fillPoly(fine, [np.rint(np.float32(points) * FINE).astype(np.int32)], 1)
    return fine


def grained(size: tuple[int, int], colour: tuple[float, ...]) -> np.ndarray:
    """A ground of a colour with spots, shape [*size, 3]."""
    random = np.random.default_rng(0)
    spots = cv2.GaussianBlur(random.normal(0, 1, (*size, 3)).astype(np.float32), (0, 0), 2) * 0.05
    return np.clip(np.float32(colour) + spots, 0, 1).astype(np.float32)


def over(picture: np.ndarray, colour: tuple[float, ...], alpha: np.ndarray) -> np.ndarray:
    """A picture with a colour over it where an alpha says."""
    return np.asarray(picture + alpha[..., None] * (np.float32(colour) - picture), np.float32)
