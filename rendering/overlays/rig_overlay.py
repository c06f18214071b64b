"""Rig points drawn on a picture: their regions and the ways they go."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.rig import (
    Circle,
    Combined,
    KeyedPath,
    Polygon,
    RigMotion,
    RigPoint,
    RigRegion,
    Wave,
    displacement,
    linear_part,
)
from .canvas import Colour, canvas_from, circle, draw_dot, draw_lines, fill_area, in_dtype_of, see_through, thin_width

__all__ = ["RIG_COLOURS", "draw_rig"]

RIG_COLOURS: dict[str, Colour] = {"Pinned": (255, 80, 100), "KeyedPath": (215, 130, 255), "Wave": (255, 205, 60)}
_TURN_COLOUR: Colour = (90, 225, 215)


def draw_rig(image: NDArray[Any], rig_points: Sequence[RigPoint], t: float, *, scale: ArrayLike = 1.0) -> NDArray[Any]:
    """The picture with rig points, their regions and the ways they go.

    Args:
        image: RGB, uint8 or float in 0..1, shape [h, w, 3].
        rig_points: pins in red, keyed paths in violet, waves in yellow, what turns or is squashed in turquoise.
        t: time at which they are shown [s].
        scale: picture's size over the illustration's, a number or (x, y).
    """
    canvas, scale = canvas_from(image), np.asarray(scale, dtype=np.float64)
    unit = thin_width(canvas)
    for rig_point in rig_points:
        colour = RIG_COLOURS.get(type(rig_point.motion).__name__, _TURN_COLOUR)
        position = np.array(rig_point.position)
        moved, (turned, _) = displacement(rig_point.motion, t), linear_part(rig_point.motion, t)
        drawn = _outlines(rig_point.position, rig_point.region)
        outlines = [((outline - position) @ turned.T + position + moved) * scale for outline in drawn]
        see_through(canvas, partial(fill_area, outlines=outlines, colour=colour), 0.2)
        for outline in outlines:
            draw_lines(canvas, [np.concatenate([outline, outline[:1]])], colour, 2 * unit)
        draw_lines(canvas, [way * scale for way in _way(rig_point)], colour, 2 * unit)
        draw_dot(canvas, (position + moved) * scale, colour, 4 * unit)
    return in_dtype_of(canvas, image)


def _outlines(position: tuple[float, float], region: RigRegion) -> list[NDArray[np.float64]]:
    if isinstance(region, Circle):
        return [circle(position, region.radius)]
    if isinstance(region, Polygon):
        return [np.array(region.points)]
    contours, _ = cv2.findContours(region.mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    return [contour[:, 0] + 0.5 for contour in contours]


def _way(rig_point: RigPoint) -> list[NDArray[np.float64]]:
    """The line along which a rig point goes."""
    position, motion = np.array(rig_point.position), rig_point.motion
    singles = motion.motions if isinstance(motion, Combined) else (motion,)
    spans = [span for single in singles for span in _span(single)]
    if not spans:
        return []
    return [position + displacement(motion, np.linspace(min(spans), max(spans), 129))]


def _span(motion: RigMotion) -> tuple[float, ...]:
    """First and last time of the way that a motion leads along, none where it stays in its place [s]."""
    if isinstance(motion, Wave):
        return 0.0, motion.period
    return (motion.times[0], motion.times[-1]) if isinstance(motion, KeyedPath) else ()
