"""How Stable Video Diffusion alone makes a clip of any length: segments of 14 frames that overlap.

Nothing in it reads reference frames: the picture that a segment is conditioned on is its own first frame. The first
segment begins with the illustration. A later one begins with frames of the one before: it is conditioned on the first
of them, and made to agree with all of them in every step.
"""

from __future__ import annotations

from dataclasses import replace

from ...physics.errors import require
from .frame_layout import CLIP_FRAMES, OVERLAP, FrameLayout
from .segments import Segment

__all__ = ["plan_plain_segments"]


def plan_plain_segments(frames: int, overlap: int = OVERLAP) -> tuple[Segment, ...]:
    """The segments that make a clip; surplus frames of the last one show the last frame again, and are dropped.

    Args:
        frames: of the clip, the reference picture included; 2 or more.
        overlap: frames that neighbouring segments share.
    """
    require("frames", frames, frames >= 2, "2 or more: the reference picture and one to be made")
    require("overlap", overlap, 1 <= overlap < CLIP_FRAMES, f"1 to {CLIP_FRAMES - 1} frames")
    slots = tuple(range(CLIP_FRAMES))
    shared = slots[-overlap:]
    segments = [Segment(FrameLayout.plain(), _within(frames, 0), (), (), slots, slots[1:])]
    while (end := _end(segments)) < frames:
        noise = segments[-1].noise
        segments.append(
            Segment(
                FrameLayout.plain(),
                _within(frames, end - overlap),
                (),
                shared,
                (*noise[-overlap:], *noise[:-overlap]),
                slots[overlap:],
                conditioned_on=shared[0],
            )
        )
    last = segments[-1]
    made = last.made[: len(last.made) - (_end(segments) - frames)]
    return (*segments[:-1], replace(last, made=made))


def _end(segments: list[Segment]) -> int:
    return 1 + sum(len(segment.made) for segment in segments)


def _within(frames: int, start: int) -> tuple[int, ...]:
    return tuple(min(frame, frames - 1) for frame in range(start, start + CLIP_FRAMES))
