"""How a gap of any length between two keyframes is filled by clips of a fixed number of frames."""

from __future__ import annotations

from itertools import pairwise

from ...physics.errors import require

__all__ = ["clips_in", "drawn_in_clip", "inner_keyframes", "sketched_in_clip"]


def inner_keyframes(gap: int, clip_gap: int) -> list[int]:
    """Frames of a long gap that a first clip draws as keyframes for clips between them; none in a short gap.

    Args:
        gap: frames from one keyframe to the next.
        clip_gap: the same in a clip.
    """
    require("gap", gap, gap >= 1, "1 frame or more")
    parts = min(-(-gap // clip_gap), clip_gap)
    return [round(number * gap / parts) for number in range(1, parts)]


def clips_in(gap: int, clip_gap: int) -> int:
    """How many clips are drawn to fill a gap."""
    if gap == 1:
        return 0
    inner = inner_keyframes(gap, clip_gap)
    return 1 + sum(clips_in(after - before, clip_gap) for before, after in pairwise([0, *inner, gap]) if inner)


def sketched_in_clip(gap: int, clip_gap: int) -> list[int]:
    """For each frame of a clip the nearest frame of the gap, 0..gap, whose sketch leads it."""
    return [int(number * gap / clip_gap + 0.5) for number in range(clip_gap + 1)]


def drawn_in_clip(frame: int, gap: int, clip_gap: int) -> int:
    """The frame of the clip that is nearest to a frame between the keyframes, never a keyframe's own."""
    return min(max(int(frame * clip_gap / gap + 0.5), 1), clip_gap - 1)
