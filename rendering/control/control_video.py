"""Clips that lead a video model: warped pictures with what is missing in them, moving lines, first and last frames.

The model's node takes them as they are; see ``ModelFormat`` for their length and size.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.errors import require
from ...physics.motion import FlowSequence, Motion
from ..composite import LayeredRenderer
from ..pictures import as_float, over
from ..sketch import WarpMode, warped_sketches
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
    renderer: Callable[[Motion], LayeredRenderer] | None = None,
) -> Iterator[tuple[FloatImage, FloatImage]]:
    """The illustration with its parts moved, and what they have uncovered, for the model to paint.

    Args:
        image: RGB, uint8 or float32 in 0 to 1, shape [h, w, 3].
        masks: one for each body of the motion, shape [h, w].
        motion: of the bodies.
        form: length and size of the clip.
        plate: what is behind all bodies, of the image's shape and dtype. With it nothing is missing: holes stay 0.
        grow: how far holes reach beyond what was uncovered [px of the illustration].
        renderer: makes what draws a motion, such as :meth:`LayeredRenderer.of_artwork`, instead of cutting parts out of
            the image. Where somebody drew what is behind the bodies, nothing is missing either.

    Yields:
        For each frame RGB in 0 to 1, shape [height, width, 3], grey in the holes; and the holes, 0 or 1, shape
        [height, width].

    Raises:
        InvalidInputError: the inputs do not fit together.
    """
    require("grow", grow, 0 <= grow <= 64, "0 to 64 px")
    drawing = _drawing(image, masks, form.sampled(motion), plate, renderer)
    square = np.ones((2 * grow + 1,) * 2, np.uint8)
    for t in range(len(drawing)):
        if drawing.drawn_plate:
            frame = _shown(drawing, t, form)
            yield frame, np.zeros(frame.shape[:2], dtype=np.float32)
            continue
        drawn, alpha = drawing.frame_and_alpha(t)
        frame = form.resized(as_float(over(drawn)))
        missing = cv2.dilate((drawing.uncovered_by(alpha) > 0.5).astype(np.uint8), square).astype(np.float32)
        # Moved parts, and what stands still in front of them, lie over the hole, however far it was grown.
        missing *= (alpha < 0.5) & (drawing.in_front < 0.5)
        hole = (form.resized(missing) > _HOLE).astype(np.float32)
        yield np.where(hole[..., None] > 0, np.float32(_UNKNOWN), frame), hole


def line_frames(
    sketch: NDArray[Any],
    motion: Motion,
    form: ModelFormat,
    *,
    bright_lines: bool = True,
    behind: NDArray[Any] | None = None,
    own: Sequence[NDArray[Any]] | None = None,
    at: Sequence[int] | None = None,
) -> Iterator[FloatImage]:
    """A line drawing that moves along with the bodies.

    Args:
        sketch: paper 1, lines 0, shape [h, w].
        motion: of the bodies.
        form: length and size of the clip.
        bright_lines: white lines on black, as edge detectors draw; otherwise dark lines on white paper.
        behind: sketch of what is behind the bodies; only beside ``own``.
        own: sketch of each body's own layer, whose lines then move layer by layer: see
            :func:`~physanimator.rendering.sketch.warped_sketches`.
        at: numbers of the clip's frames, from 0; all when None.

    Yields:
        For each frame a picture in 0 to 1, shape [height, width].

    Raises:
        InvalidInputError: the sketch has another size than the motion's illustration.
    """
    mode: WarpMode = "paper" if own is None else "layered"
    flow = FlowSequence(form.sampled(motion))
    for warped in warped_sketches(sketch, flow, at, mode=mode, behind=behind, own=own):
        drawn = form.resized(warped.sketch)
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
    renderer: Callable[[Motion], LayeredRenderer] | None = None,
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
        renderer: see :func:`warped_frames`.

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
    drawing = _drawing(image, masks, motion, plate, renderer)
    start, end = (_shown(drawing, number % count, form) for number in (first, last))
    return start, end


def _drawing(
    image: NDArray[Any],
    masks: Sequence[ArrayLike],
    motion: Motion,
    plate: NDArray[Any] | None,
    renderer: Callable[[Motion], LayeredRenderer] | None,
) -> LayeredRenderer:
    return LayeredRenderer(image, masks, motion, plate=plate) if renderer is None else renderer(motion)


def _shown(drawing: LayeredRenderer, t: int, form: ModelFormat) -> FloatImage:
    """A frame in the model's size, over white where it is transparent."""
    return form.resized(as_float(over(drawing.frame(t))))
