"""Line drawings of others: lines light or dark, in a size of their own."""

from __future__ import annotations

from typing import Any, Literal, get_args

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require

__all__ = ["LINE_TONES", "LineTones", "dark_lines", "has_light_lines", "sized_sketch"]

LineTones = Literal["automatic", "dark on light", "light on dark"]
LINE_TONES: tuple[LineTones, ...] = get_args(LineTones)

# Paper of edge and line detectors is black or nearly so; a drawing on white paper is never dark over most of it.
_DARK_PAPER = 0.25
# Tools that keep proportions round the sides, some of them to multiples of 8 px.
_SAME_PROPORTIONS = 0.01


def has_light_lines(sketch: NDArray[Any]) -> bool:
    """Whether a line drawing is light on dark: more than half of it is nearly black.

    Args:
        sketch: in 0 to 1, any shape.
    """
    return float((sketch < _DARK_PAPER).mean()) > 0.5


def dark_lines(sketch: NDArray[Any], tones: LineTones = "automatic") -> NDArray[Any]:
    """A line drawing as dark lines on light paper, as all that works with sketches here takes it.

    Args:
        sketch: in 0 to 1, any shape.
        tones: what it is. "automatic" looks, see :func:`has_light_lines`.

    Raises:
        InvalidInputError: there are no such tones.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.sketch import dark_lines
        >>> edges = np.zeros((4, 4), np.float32)
        >>> edges[:, 1] = 1
        >>> dark_lines(edges)[0].tolist()
        [1.0, 0.0, 1.0, 1.0]
    """
    require("sketch_lines", tones, tones in LINE_TONES, f"one of {', '.join(LINE_TONES)}")
    light = has_light_lines(sketch) if tones == "automatic" else tones == "light on dark"
    return 1 - sketch if light else sketch


def sized_sketch(sketch: NDArray[Any], width: int, height: int, *, name: str = "sketch") -> NDArray[Any]:
    """A line drawing in the illustration's size; detectors draw in a size of their own.

    Args:
        sketch: in 0 to 1, shape [h, w] or [h, w, 3].
        width: of the illustration [px].
        height: of the illustration [px].
        name: what the user calls the drawing.

    Raises:
        InvalidInputError: the drawing has other proportions, so that it shows something else or only a part.
    """
    h, w = sketch.shape[:2]
    if (w, h) == (width, height):
        return sketch
    # One of the drawing's own pixels more or less is rounding, too.
    alike = abs(w * height / h - width) <= max(_SAME_PROPORTIONS * width, width / w)
    size = f"of the illustration's size, {width} x {height} px, or of its proportions"
    require(name, f"{w} x {h} px", alike, size)
    way = cv2.INTER_AREA if w > width else cv2.INTER_CUBIC
    resized = cv2.resize(np.ascontiguousarray(sketch, dtype=np.float32), (width, height), interpolation=way)
    return np.clip(resized, 0.0, 1.0)
