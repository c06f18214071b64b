"""Loops: the keyframe pair of the last and the first, and the frames around the wrap."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require
from ...physics.motion import Motion
from .backend import Clip

__all__ = ["check_loop", "led_around", "loop_frames"]

Picture = NDArray[Any]


def check_loop(loop: int, indices: Sequence[int], motion: Motion | None, *, alone: bool) -> None:
    """Refuse what no loop can be.

    Args:
        loop: its number of frames.
        indices: frame number of each keyframe.
        motion: of the clip, if it is known.
        alone: no frames are given besides the keyframes.

    Raises:
        InvalidInputError: see above.
    """
    whole = isinstance(loop, int | np.integer) and not isinstance(loop, bool)
    require("loop", loop, whole and loop > indices[-1], f"a number of frames above the last keyframe's {indices[-1]}")
    require("keyframes", len(indices), len(indices) >= 2, "2 or more in a loop")
    known = motion is None or len(motion) >= loop
    require("loop", loop, known, f"at most the motion's {0 if motion is None else len(motion)} frames")
    require("before and after", "frames", alone, "left out in a loop, of which all other frames are in-betweens")


def led_around(clip: Clip, loop: int) -> Clip:
    """A clip that goes on to its first keyframe once more, with the motion and sketches up to there."""
    start, motion = clip.indices[0], clip.motion
    again = range(start + 1)
    if motion is not None:
        positions = motion.positions[:loop]
        motion = replace(motion, positions=np.concatenate([positions, positions[list(again)]]), loop=None)
    sketches = [*clip.sketches[:loop], *(clip.sketches[t] for t in again)] if len(clip.sketches) else ()
    keyframes, indices = [*clip.keyframes, clip.keyframes[0]], (*clip.indices, loop + start)
    return replace(clip, keyframes=keyframes, indices=indices, motion=motion, sketches=sketches)


def loop_frames(
    between: Callable[[int], Iterable[Picture]], keyframes: Sequence[Picture], *, start: int
) -> Iterator[Picture]:
    """All frames of a loop, frame 0 first.

    Args:
        between: gives the frames between a keyframe of this number and the next; the last one's next is the first.
        keyframes: each once.
        start: frame number of the first keyframe. The frames before it are the last ones before it comes again.
    """
    last = len(keyframes) - 1
    closing = list(between(last)) if start else []
    ahead = len(closing) - start
    yield from closing[ahead:]
    for number, keyframe in enumerate(keyframes):
        yield keyframe
        if number < last or not start:
            yield from between(number)
    yield from closing[:ahead]
