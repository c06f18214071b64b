"""Clips that lead a video model: warped pictures with what is missing in them, moving lines, first and last frames.

The model's node takes them as they are; see ``ModelFormat`` for their length and size.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.errors import require
from ...physics.motion import FlowSequence, Motion
from ..composite import LayeredRenderer
from ..pictures import as_float
from ..sketch import warp_sketch
from .model_format import ModelFormat

__all__ = ["first_and_last", "line_frames", "warped_frames"]

FloatImage = NDArray[np.float32]

# What VACE's control videos show where the model shall paint.
_UNKNOWN = 0.5
# What is uncovered by no more than this, 5 levels of 255, counts as covered.
_HOLE = 0.02


def warped_frames(
    image: NDArray[Any],
    masks: Sequence[ArrayLike],
    motion: Motion,
    form: ModelFormat,
    *,
    plate: NDArray[Any] | None = None,
    grow: int = 4,
) -> Iterator[tuple[FloatImage, FloatImage]]:
    """The illustration with its parts moved, and what they have uncovered, for the model to paint.

    Args:
        image: RGB, uint8 or float32 in 0 to 1, shape [h, w, 3].
        masks: one for each body of the motion, shape [h, w].
        motion: of the bodies.
        form: length and size of the clip.
        plate: what is behind all bodies, of the image's shape and dtype. With it nothing is missing: holes stay 0.
        grow: how far holes reach beyond what was uncovered [px of the illustration].

    Yields:
        For each frame RGB in 0 to 1, shape [height, width, 3], grey in the holes; and the holes, 0 or 1, shape
        [height, width].

    Raises:
        InvalidInputError: the inputs do not fit together.
    """
    require("grow", grow, 0 <= grow <= 64, "0 to 64 px")
    renderer = LayeredRenderer(image, masks, form.sampled(motion), plate=plate)
    square = np.ones((2 * grow + 1,) * 2, np.uint8)
    for t in range(len(renderer)):
        if plate is not None:
            frame = form.resized(as_float(renderer.frame(t)))
            yield frame, np.zeros(frame.shape[:2], dtype=np.float32)
            continue
        drawn, alpha = renderer.frame_and_alpha(t)
        frame = form.resized(as_float(drawn))
        missing = cv2.dilate((renderer.uncovered_by(alpha) > 0.5).astype(np.uint8), square).astype(np.float32)
        # Moved parts lie over the hole, however far it was grown.
        missing *= alpha < 0.5
        hole = (form.resized(missing) > _HOLE).astype(np.float32)
        yield np.where(hole[..., None] > 0, np.float32(_UNKNOWN), frame), hole


def line_frames(
    sketch: NDArray[Any], motion: Motion, form: ModelFormat, *, bright_lines: bool = True
) -> Iterator[FloatImage]:
    """A line drawing that moves along with the bodies.

    Args:
        sketch: paper 1, lines 0, shape [h, w].
        motion: of the bodies.
        form: length and size of the clip.
        bright_lines: white lines on black, as edge detectors draw; otherwise dark lines on white paper.

    Yields:
        For each frame a picture in 0 to 1, shape [height, width].

    Raises:
        InvalidInputError: the sketch has another size than the motion's illustration.
    """
    for field in FlowSequence(form.sampled(motion)):
        drawn = form.resized(warp_sketch(sketch, field).sketch)
        yield np.asarray(1 - drawn if bright_lines else drawn, dtype=np.float32)


def first_and_last(
    image: NDArray[Any],
    masks: Sequence[ArrayLike],
    motion: Motion,
    form: ModelFormat,
    *,
    first: int = 0,
    last: int = -1,
    plate: NDArray[Any] | None = None,
) -> tuple[FloatImage, FloatImage]:
    """Two frames of a motion, between which a video model draws its own.

    Args:
        image: RGB, uint8 or float32 in 0 to 1, shape [h, w, 3].
        masks: one for each body of the motion, shape [h, w].
        motion: of the bodies.
        form: size of the pictures; its length does not matter here.
        first: number of the first frame of the motion; negative ones count from its end.
        last: number of the last frame.
        plate: what is behind all bodies, of the image's shape and dtype; None makes a clean plate.

    Returns:
        Both frames, RGB in 0 to 1, shape [height, width, 3].

    Raises:
        InvalidInputError: there is no such frame, or the inputs do not fit together.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion
        >>> from physanimator.physics.scene import Body
        >>> from physanimator.rendering.control import ModelFormat, first_and_last
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mask = np.pad(np.ones((40, 40)), 10)
        >>> mesh = mesh_from_mask(mask, spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> first, last = first_and_last(picture, [mask], motion, ModelFormat(width=64, height=64))
        >>> first.shape
        (64, 64, 3)
    """
    count = len(motion)
    for name, number in (("first_frame", first), ("last_frame", last)):
        require(name, number, -count <= number < count, f"a frame of the motion, {-count} to {count - 1}")
    renderer = LayeredRenderer(image, masks, motion, plate=plate)
    start, end = (form.resized(as_float(renderer.frame(number % count))) for number in (first, last))
    return start, end
