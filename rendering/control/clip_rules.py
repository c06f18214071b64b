"""Rules by which a picture and a motion of any size and length come to what a video model takes, and what they did."""

from __future__ import annotations

from itertools import product
from typing import Literal, get_args

from ...physics.checks import check_whole
from ...physics.errors import require
from ...physics.motion import Motion
from .model_format import FRAME_STEP, SIZE_STEP, ModelFormat

__all__ = ["AREAS", "TIMINGS", "Timing", "suitable_length", "suitable_size", "timed", "told_rules"]

AREAS = {"480p": 832 * 480, "720p": 1280 * 720}
"""Areas that Wan has been trained on, by their usual names [px]."""

Timing = Literal["whole motion", "frame by frame", "own length"]
TIMINGS: tuple[Timing, ...] = get_args(Timing)
"""How a motion comes to a number of frames: spread over them from its first frame to its last; its own frames one by
one, the rest left out or the last one held; or its own frames, the last one held until the length is 4 k + 1."""


def suitable_size(width: int, height: int, area: int) -> tuple[int, int]:
    """Width and height for a picture of any size: multiples of 16, of about an area and never more, in its proportions.

    Of the sizes nearby it is the one that shows most of the picture; the rest is to be cut off, a few pixels.

    Args:
        width: of the picture [px].
        height: of the picture [px].
        area: at most so large [px].

    Raises:
        InvalidInputError: an argument is out of range.

    Examples:
        >>> from physanimator.rendering.control import AREAS, suitable_size
        >>> suitable_size(1280, 720, AREAS["480p"])
        (832, 464)
        >>> suitable_size(1000, 1500, AREAS["720p"])
        (784, 1168)
    """
    check_whole("width", width, 1, 1_000_000, unit=" px")
    check_whole("height", height, 1, 1_000_000, unit=" px")
    check_whole("area", area, SIZE_STEP**2, 16_384**2, unit=" px")
    across = (area * width / height) ** 0.5
    near = product(_near(across, area), _near(area / across, area))

    def shown(size: tuple[int, int]) -> float:
        apart = (size[0] * height) / (size[1] * width)
        return min(apart, 1 / apart)

    fitting = [size for size in near if size[0] * size[1] <= area]
    return max(fitting, key=lambda size: (shown(size) ** 4 * size[0] * size[1], size))


def _near(side: float, area: int) -> list[int]:
    """Multiples of 16 around a side, of which one is possible with any other side."""
    largest = min(16_384, area // SIZE_STEP) // SIZE_STEP
    below = int(side) // SIZE_STEP
    return sorted({SIZE_STEP * min(max(1, below + step), largest) for step in (-1, 0, 1)})


def suitable_length(frames: int) -> int:
    """The shortest length 4 k + 1 with room for so many frames.

    Examples:
        >>> from physanimator.rendering.control import suitable_length
        >>> [suitable_length(frames) for frames in (1, 2, 5, 121, 122)]
        [1, 5, 5, 121, 125]
    """
    check_whole("frames", frames, 1, 100_001)
    return -(-(frames - 1) // FRAME_STEP) * FRAME_STEP + 1


def timed(motion: Motion, form: ModelFormat, timing: Timing) -> Motion:
    """A motion in the frames of a form; with "own length" the form's must be :func:`suitable_length` of the motion's.

    Raises:
        InvalidInputError: no such timing, or the lengths do not fit.
    """
    require("timing", timing, timing in TIMINGS, f"one of {', '.join(TIMINGS)}")
    if timing == "whole motion":
        return form.sampled(motion)
    expected = suitable_length(len(motion))
    fits = timing == "frame by frame" or form.frames == expected
    require("frames", form.frames, fits, f"{expected} for a motion of {len(motion)} frames with their own length")
    chosen = [min(number, len(motion) - 1) for number in range(form.frames)]
    return Motion(motion.bodies, motion.positions[chosen], motion.frame_rate)


def told_rules(motion: Motion, form: ModelFormat, timing: Timing) -> list[str]:
    """What becomes of a motion's frames and of its picture, a sentence each.

    Args:
        motion: as it was simulated.
        form: what it comes to.
        timing: how.
    """
    return [_told_time(motion, form, timing), _told_size(motion, form)]


def _told_time(motion: Motion, form: ModelFormat, timing: Timing) -> str:
    own, frames = len(motion), form.frames
    rate = timed(motion, form, timing).frame_rate
    if timing == "whole motion":
        told = f"{own} frames at {motion.frame_rate:g} a second are drawn as {frames} at {rate:.4g}, from first to last"
        return f"{told}." if own != frames else f"The {own} frames stay as they are, at {rate:.4g} a second."
    if own > frames:
        return f"The first {frames} of {own} frames are taken, {own - frames} are left out; {rate:g} a second."
    held = f"{own} frames are taken one by one, and the last is held for {frames - own} more; {rate:g} a second."
    return held if frames > own else f"The {own} frames stay as they are, at {rate:g} a second."


def _told_size(motion: Motion, form: ModelFormat) -> str:
    size = f"{motion.width} x {motion.height} px become {form.width} x {form.height} px"
    scale = form.width / motion.width, form.height / motion.height
    if form.fit == "stretch":
        return f"{size}, stretched by {scale[0] / scale[1]:.3f} across."
    lost = [1 - each / max(scale) for each in scale]
    names = [("left and right", lost[0]), ("top and bottom", lost[1])]
    cut = [f"{100 * share / 2:.1f} % are cut off at {where}, each" for where, share in names if share > 5e-4]
    return f"{size}; {cut[0]}." if cut else f"{size}; nothing is cut off."
