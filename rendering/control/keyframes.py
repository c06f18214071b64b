"""Frames of a motion at chosen places of a clip, and the clip that holds nothing but them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.errors import InvalidInputError, require
from ...physics.motion import Motion
from ..composite import LayeredRenderer
from ..pictures import as_float, over
from .model_format import FRAME_STEP, ModelFormat

__all__ = ["known_latents", "moments", "motion_keyframes", "placed_keyframes"]

FloatImage = NDArray[np.float32]

UNKNOWN = 0.5
"""The grey that video models are shown where nothing is given."""


def moments(numbers: Sequence[int], frames: int, *, name: str = "keyframes") -> tuple[int, ...]:
    """Frame numbers of a clip, counted from its first frame and in order.

    Args:
        numbers: of the frames; negative ones count from the clip's end.
        frames: of the clip.
        name: what the user calls the numbers.

    Raises:
        InvalidInputError: there are none, one lies outside the clip, or one comes twice.

    Examples:
        >>> from physanimator.rendering.control import moments
        >>> moments([-1, 0, 40], 81)
        (0, 40, 80)
    """
    require(name, "none", len(numbers) > 0, "at least one frame, such as 0, 40, -1")
    for number in numbers:
        require(name, number, -frames <= number < frames, f"frames of the clip, {-frames} to {frames - 1}")
    found = sorted(number % frames for number in numbers)
    twice = next((a for a, b in pairwise(found) if a == b), None)
    require(name, f"frame {twice} twice", twice is None, "different frames")
    return tuple(found)


def motion_keyframes(
    image: NDArray[Any],
    masks: Sequence[ArrayLike],
    motion: Motion,
    form: ModelFormat,
    *,
    at: Sequence[int],
    plate: NDArray[Any] | None = None,
    renderer: Callable[[Motion], LayeredRenderer] | None = None,
) -> list[FloatImage]:
    """The illustration with its parts moved, at some frames of a clip that shows the whole motion.

    Args:
        image: RGB, uint8 or float32 in 0 to 1, shape [h, w, 3].
        masks: one for each body of the motion, shape [h, w].
        motion: of the bodies.
        form: length and size of the clip.
        at: numbers of the clip's frames, see :func:`moments`.
        plate: what is behind all bodies, of the image's shape and dtype; None makes a clean plate.
        renderer: see :func:`warped_frames`.

    Returns:
        One picture for each number, in the order of the clip: RGB in 0 to 1, shape [height, width, 3].

    Raises:
        InvalidInputError: there is no such frame, or the inputs do not fit together.
    """
    wanted = moments(at, form.frames)
    sampled = form.sampled(motion)
    drawing = LayeredRenderer(image, masks, sampled, plate=plate) if renderer is None else renderer(sampled)
    return [form.resized(as_float(over(drawing.frame(t)))) for t in wanted]


def placed_keyframes(pictures: Sequence[NDArray[Any]], at: Sequence[int], frames: int) -> tuple[FloatImage, FloatImage]:
    """A clip that shows keyframes in their places and grey elsewhere, and where it is to be painted.

    Args:
        pictures: RGB in 0 to 1, shape [h, w, 3] each.
        at: the frame of each, from 0.
        frames: of the clip.

    Returns:
        The clip, shape [frames, h, w, 3]; and 1 in each frame that is missing, 0 in a keyframe, shape [frames, h, w].

    Raises:
        InvalidInputError: there is not one place for each picture, or a place lies outside the clip.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.control import placed_keyframes
        >>> clip, missing = placed_keyframes([np.ones((2, 2, 3)), np.zeros((2, 2, 3))], [0, 4], 5)
        >>> clip[:, 0, 0, 0].tolist(), missing[:, 0, 0].tolist()
        ([1.0, 0.5, 0.5, 0.5, 0.0], [0.0, 1.0, 1.0, 1.0, 0.0])
    """
    if len(pictures) != len(at):
        raise InvalidInputError(
            f"indices must give one frame for each of {len(pictures)} keyframes. Got: {len(at)} frames"
        )
    moments(at, frames, name="indices")
    height, width = pictures[0].shape[:2]
    clip = np.full((frames, height, width, 3), UNKNOWN, dtype=np.float32)
    missing = np.ones((frames, height, width), dtype=np.float32)
    for picture, t in zip(pictures, at, strict=True):
        clip[t], missing[t] = picture, 0.0
    return clip, missing


def known_latents(at: Sequence[int], frames: int) -> NDArray[np.bool_]:
    """Which frames of each step of Wan's latents are given.

    The first step holds the first frame, four times; each further one holds the next four frames.

    Args:
        at: numbers of the given frames, from 0.
        frames: of the clip, 4 k + 1.

    Returns:
        Shape [k + 1, 4].

    Examples:
        >>> from physanimator.rendering.control import known_latents
        >>> known_latents([0, 8], 9).astype(int).tolist()
        [[1, 1, 1, 1], [0, 0, 0, 0], [0, 0, 0, 1]]
    """
    known = np.zeros(frames, dtype=bool)
    known[list(at)] = True
    return np.concatenate([np.repeat(known[:1], FRAME_STEP - 1), known]).reshape(-1, FRAME_STEP)
