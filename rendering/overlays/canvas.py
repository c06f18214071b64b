"""Drawing on a picture: lines with a dark casing, discs and see-through areas.

Every line is drawn in a bright colour over a wider dark one, so that it can be read on light and on dark pictures.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..pictures import as_picture, as_uint8

__all__ = [
    "DARK",
    "FRACTION_BITS",
    "Canvas",
    "Colour",
    "canvas_from",
    "circle",
    "draw_dot",
    "draw_lines",
    "draw_uncased",
    "fill_area",
    "fill_disc",
    "fixed_point",
    "in_dtype_of",
    "scale_to",
    "see_through",
    "thin_width",
]

Canvas = NDArray[np.uint8]
Colour = tuple[int, int, int]

DARK: Colour = (20, 20, 30)
"""Of the casing of every line."""

FRACTION_BITS = 4
"""OpenCV draws at whole numbers of 2^-4 pixels."""

# Coordinates beyond this, four million pixels, lie far off any picture; they are cut to fit into OpenCV's 32 bits.
_FARTHEST = 2**26


def canvas_from(image: NDArray[Any]) -> Canvas:
    """A uint8 copy to draw on."""
    return np.array(as_uint8(as_picture(image)), order="C")


def in_dtype_of(canvas: Canvas, image: NDArray[Any]) -> NDArray[Any]:
    """What was drawn, as the picture that it was drawn on is given: uint8, or float in 0..1."""
    dtype = np.asarray(image).dtype
    return (canvas / 255).astype(dtype) if dtype.kind == "f" else canvas


def scale_to(canvas: Canvas, width: int, height: int) -> NDArray[np.float64]:
    """Size of a canvas over that of the illustration, (x, y)."""
    return np.array([canvas.shape[1] / width, canvas.shape[0] / height])


def thin_width(canvas: Canvas) -> int:
    """Width of a thin line [px]: 1 for every 1280 px of the longer side, so that overlays look alike at every size."""
    return max(1, round(max(canvas.shape[:2]) / 1280))


def fixed_point(points: ArrayLike) -> NDArray[np.int32]:
    """Coordinates as cv2 draws them: pixel centres at integers, in fixed point."""
    return np.rint(np.clip((np.asarray(points) - 0.5) * 2**FRACTION_BITS, -_FARTHEST, _FARTHEST)).astype(np.int32)


def draw_uncased(canvas: Canvas, lines: Sequence[NDArray[np.int32]], colour: Colour, width: int) -> None:
    """Polylines in one colour, in coordinates of ``fixed_point``."""
    cv2.polylines(canvas, lines, False, colour, width, cv2.LINE_AA, FRACTION_BITS)


def draw_lines(canvas: Canvas, lines: Any, colour: Colour, width: int) -> None:
    """Polylines with a dark casing."""
    fixed = [fixed_point(line) for line in lines]
    draw_uncased(canvas, fixed, DARK, width + 2)
    draw_uncased(canvas, fixed, colour, width)


def fill_area(canvas: Canvas, outlines: Sequence[NDArray[np.float64]], colour: Colour) -> None:
    """What lies inside an odd number of outlines."""
    cv2.fillPoly(canvas, [fixed_point(outline) for outline in outlines], colour, cv2.LINE_AA, FRACTION_BITS)


def fill_disc(canvas: Canvas, centre: NDArray[np.float64], radius: float, colour: Colour) -> None:
    """A disc in one colour."""
    fill_area(canvas, [circle(centre, radius)], colour)


def draw_dot(canvas: Canvas, centre: NDArray[np.float64], colour: Colour, radius: float) -> None:
    """A disc with a dark casing."""
    fill_disc(canvas, centre, radius + 1.5, DARK)
    fill_disc(canvas, centre, radius, colour)


def see_through(canvas: Canvas, draw: Callable[[Canvas], Any], opacity: float) -> None:
    """Draw so that what is there shines through: an opacity of 0 draws nothing, 1 hides it."""
    layer = canvas.copy()
    draw(layer)
    cv2.addWeighted(layer, opacity, canvas, 1 - opacity, 0, dst=canvas)


def circle(centre: ArrayLike, radius: float) -> NDArray[np.float64]:
    """A closed polygon."""
    angles = np.linspace(0, 2 * np.pi, 65)
    return np.asarray(centre) + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
