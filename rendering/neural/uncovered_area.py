"""What the parts uncover in a whole clip, for an image model that paints it once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require
from ...physics.interruption import checkpoint
from ...physics.progress import Progress
from ..composite import LayeredRenderer
from ..inpainting import change_map

__all__ = ["GROWN", "LARGEST_STEP", "extended", "uncovered_area"]

FloatImage = NDArray[np.float32]

GROWN = 8.0
"""How far the area reaches beyond what is uncovered, unless something else is said [px]: a cell of Stable Diffusion's
latents."""

LARGEST_STEP = 256
"""The largest number that sides may be made multiples of."""

# What is uncovered by no more than this, 5 levels of 255, counts as covered.
_HOLE = 0.02


def uncovered_area(
    layers: LayeredRenderer,
    *,
    grow: float = GROWN,
    soft_edge: float = 0.0,
    drawn: bool = False,
    numbers: Sequence[int] | None = None,
    progress: Progress | None = None,
) -> FloatImage:
    """Where parts cover something in the drawing and leave it, be it half a pixel, in any frame.

    There a clip shows the plate, which nobody drew.

    Args:
        layers: draws the motion.
        grow: how far the area reaches beyond what is uncovered, but not into what stands still in front [px].
        soft_edge: width of a transition around it [px].
        drawn: somebody drew what is behind the parts, as in layered artwork: the area is empty.
        numbers: of the frames that count; None for all.
        progress: called after each frame with (done, total); may raise to stop.

    Returns:
        1 in the area, 0 outside, between them in the soft edge; shape [h, w].

    Raises:
        InvalidInputError: a width is out of its range, or there is no such frame.
    """
    require("grow", grow, 0 <= grow <= 1000, "0 to 1000 px")
    require("soft_edge", soft_edge, 0 <= soft_edge <= 1000, "0 to 1000 px")
    uncovered = np.zeros(layers.plate.shape[:2], dtype=np.float32)
    if drawn:
        return uncovered
    frames = range(len(layers)) if numbers is None else numbers
    for done, number in enumerate(frames, start=1):
        checkpoint()
        np.maximum(uncovered, layers.uncovered(number), out=uncovered)
        if progress is not None:
            progress(done, len(frames))
    whole = (uncovered > _HOLE).astype(np.float32)
    return change_map(whole, layers.in_front, grow=grow, soft_edge=soft_edge)


def extended(image: NDArray[Any], step: int, *, by: float | None = None) -> NDArray[Any]:
    """A picture made larger at the right and at the bottom until its sides are multiples of a number.

    Models work on cells of several pixels, and what encodes pictures for them cuts off what is left over, on both
    sides: what they painted would then lie a few pixels aside.

    Args:
        image: shape [h, w] or [h, w, c].
        step: what the sides become multiples of [px].
        by: the value there; None repeats the last row and column.

    Raises:
        InvalidInputError: the number is out of its range.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.neural.uncovered_area import extended
        >>> extended(np.zeros((720, 1275, 3), np.float32), 16).shape
        (720, 1280, 3)
    """
    require("size_step", step, 1 <= step <= LARGEST_STEP, f"1 to {LARGEST_STEP} px")
    height, width = image.shape[:2]
    kind = cv2.BORDER_REPLICATE if by is None else cv2.BORDER_CONSTANT
    return np.asarray(cv2.copyMakeBorder(image, 0, -height % step, 0, -width % step, kind, value=by or 0))
