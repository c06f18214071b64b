"""A beach ball in the style of a cartoon, drawn from its geometry: the figures' test body."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["ACCENTS", "draw_ball", "draw_sand", "draw_stage"]

_FINER = 3  # drawn so many times larger, for smooth edges
_OUTLINE = (52, 30, 58)
ACCENTS = ((236, 74, 86), (252, 190, 58), (62, 140, 206))
"""The colours of a ball's three panels, from the red one on; white ones lie between them."""
_WHITE = (255, 246, 232)
_LIGHT = np.array([-0.5, -0.62, 0.6])


def draw_stage(width: int, height: int, *, floor: float) -> NDArray[np.uint8]:
    """An empty stage: a sky that pales towards the horizon, and a floor.

    Args:
        width: of the picture [px].
        height: of the picture [px].
        floor: y of the floor's far edge [px].

    Returns:
        RGB, shape [height, width, 3].
    """
    y = np.arange(height)[:, None, None] + 0.5
    sky = _blend((150, 203, 240), (232, 244, 250), np.clip(y / floor, 0, 1))
    ground = _blend((226, 214, 190), (206, 188, 158), np.clip((y - floor) / max(1.0, height - floor), 0, 1))
    stage = np.where(y < floor, sky, ground)
    return np.rint(np.broadcast_to(stage, (height, width, 3))).astype(np.uint8)


def draw_ball(
    stage: NDArray[np.uint8],
    centre: tuple[float, float],
    radius: float,
    *,
    accents: Sequence[tuple[int, int, int]] = ACCENTS,
) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """A stage with a ball on it.

    Args:
        stage: RGB, shape [h, w, 3].
        centre: of the ball [px].
        radius: of the ball with its outline [px].
        accents: colours of its three panels.

    Returns:
        The picture, RGB, shape [h, w, 3], and the ball's coverage 0..1, shape [h, w].
    """
    height, width = stage.shape[:2]
    y, x = (np.indices((height * _FINER, width * _FINER)) + 0.5) / _FINER
    x, y = (x - centre[0]) / radius, (y - centre[1]) / radius
    distance = np.hypot(x, y)
    colours = _surface(x, y, accents)
    colours[distance > 0.955] = _OUTLINE
    colour = cv2.resize(colours, (width, height), interpolation=cv2.INTER_AREA)
    coverage = cv2.resize((distance <= 1).astype(np.float32), (width, height), interpolation=cv2.INTER_AREA)
    picture = stage + coverage[..., None] * (colour - stage)
    return np.rint(picture).astype(np.uint8), coverage


def draw_sand(picture: NDArray[np.uint8], *, top: float) -> NDArray[np.uint8]:
    """The picture with a drift of sand in front, in which a ball can stand.

    Args:
        picture: RGB, shape [h, w, 3].
        top: y of the drift's mean height [px].

    Returns:
        A new picture.
    """
    y, x = np.indices(picture.shape[:2]) + 0.5
    depth = y - (top + 4 * np.sin(x / 41) + 2 * np.sin(x / 17 + 1))
    sand = _blend((232, 214, 178), (206, 182, 142), np.clip(depth / 80, 0, 1)[..., None])
    sand[depth < 3] = _OUTLINE
    cover = np.clip(depth + 0.5, 0, 1)[..., None]
    return np.rint(picture + cover * (sand - picture)).astype(np.uint8)


def _surface(
    x: NDArray[np.float64], y: NDArray[np.float64], accents: Sequence[tuple[int, int, int]]
) -> NDArray[np.float32]:
    """Colours of a sphere of radius 1 about the origin in two tones and a highlight, shape [..., 3]."""
    z = np.sqrt(np.maximum(0.0, 1 - x**2 - y**2))
    normal = np.stack([x, y, z], axis=-1)
    # The poles of the panels: one looks over the viewer's shoulder, so that the seams show how the ball bends.
    pole = np.array([0.34, -0.5, 0.8])
    pole /= np.linalg.norm(pole)
    east = np.cross([0.0, 1.0, 0.0], pole)
    east /= np.linalg.norm(east)
    along, up, out = normal @ east, normal @ np.cross(pole, east), normal @ pole
    angle = np.mod(np.arctan2(up, along) / (2 * np.pi), 1.0) * 2 * len(accents)
    panels = np.array([colour for accent in accents for colour in (accent, _WHITE)], dtype=np.float32)
    colours = panels[angle.astype(int) % len(panels)]
    seam = np.minimum(angle % 1, 1 - angle % 1) * np.sqrt(np.maximum(0.0, 1 - out**2)) < 0.028
    colours[seam] = _OUTLINE
    cap = np.abs(out) > 0.965
    colours[cap] = _WHITE
    colours[(np.abs(out) > 0.952) & ~cap] = _OUTLINE
    light = normal @ (_LIGHT / np.linalg.norm(_LIGHT))
    colours[light < 0.16] *= np.array((0.74, 0.68, 0.82), dtype=np.float32)
    glint = ((x + 0.42) * 0.8 + (y + 0.5) * 0.6) ** 2 / 0.012 + ((y + 0.5) * 0.8 - (x + 0.42) * 0.6) ** 2 / 0.034 < 1
    colours[glint] = (255, 255, 255)
    return colours


def _blend(
    first: tuple[int, int, int], second: tuple[int, int, int], share: NDArray[np.float64]
) -> NDArray[np.float64]:
    return np.array(first) + share * (np.array(second, dtype=np.float64) - np.array(first))
