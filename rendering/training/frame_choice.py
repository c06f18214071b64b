"""Which frames of a clip are trained on together."""

from __future__ import annotations

import numpy as np

from ...physics.errors import require

__all__ = ["LONGEST_STRIDE", "reference_and_window", "strided_window"]

LONGEST_STRIDE = 6
"""Most frames from one to the next that ToonCrafter was trained with."""


def reference_and_window(frames: int, window: int, chance: np.random.Generator) -> tuple[int, ...]:
    """A reference frame and a run of frames behind it, as LVCD was trained.

    The reference comes from the earliest quarter of the frames before the run, so that the network learns to follow a
    picture that is some time ago.

    Args:
        frames: of the clip.
        window: frames of the run.
        chance: draws.

    Returns:
        Numbers of the reference and of the run's frames, window + 1 of them.
    """
    require("clip", f"{frames} frames", frames > window, f"of at least {window + 1} frames")
    start = int(chance.integers(1, frames - window + 1))
    reference = int(chance.integers(max(start // 4, 1)))
    return (reference, *range(start, start + window))


def strided_window(
    frames: int, window: int, chance: np.random.Generator, *, firsts: tuple[int, ...] = ()
) -> tuple[tuple[int, ...], int]:
    """Frames at equal distances, as ToonCrafter was trained.

    Args:
        frames: of the clip.
        window: frames that are taken.
        chance: draws.
        firsts: frames that may be the first one; any by default.

    Returns:
        The numbers of the frames, and their distance, 1 to 6.
    """
    require("clip", f"{frames} frames", frames >= window, f"of at least {window} frames")
    usable = [first for first in firsts or range(frames) if first + window <= frames]
    require("first frame", firsts, bool(usable), f"at most frame {frames - window}")
    longest = min((frames - 1 - min(usable)) // (window - 1), LONGEST_STRIDE)
    stride = int(chance.integers(1, longest + 1))
    fitting = [first for first in usable if first + stride * (window - 1) < frames]
    first = fitting[int(chance.integers(len(fitting)))]
    return tuple(range(first, first + stride * (window - 1) + 1, stride)), stride
