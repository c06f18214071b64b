"""How a clip of any length is made of segments (LVCD, Section 3.4).

Frames count from 0, the reference picture. The first segment makes frames 1 to 14; each later one repeats the last few
and adds the rest of its 14. Slots are places in a segment: references first, then the clip.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...physics.errors import require
from .frame_layout import CLIP_FRAMES, OVERLAP, FrameLayout

__all__ = ["Segment", "plan_segments"]


@dataclass(frozen=True)
class Segment:
    """One run of the sampler.

    Attributes:
        layout: which slots are references, and which keys each attends to.
        sketches: frame that each slot shows, whose sketch it gets.
        carried: slots of the segment before whose results condition slots 1, 2, ... of this one; all other slots are
            conditioned on the reference picture.
        blended: slots of the segment before whose denoised latents replace, in every step, those of the first clip
            slots of this one.
        noise: slot of the first segment whose initial noise each slot gets.
        made: slots whose results are new frames.
        conditioned_on: slot of the segment before whose result takes the place of the reference picture's latent.
        closes: so many of the last carried and blended slots are of the first segment, counted on from those of the
            segment before, and stand at the end of this one's clip.
    """

    layout: FrameLayout
    sketches: tuple[int, ...]
    carried: tuple[int, ...]
    blended: tuple[int, ...]
    noise: tuple[int, ...]
    made: tuple[int, ...]
    conditioned_on: int | None = None
    closes: int = 0

    @property
    def held(self) -> tuple[int, ...]:
        """Clip slots whose denoised latents the blended ones replace."""
        references, count = self.layout.references, self.layout.count
        begin = range(references, references + len(self.blended) - self.closes)
        return (*begin, *range(count - self.closes, count))


def plan_segments(frames: int, overlap: int = OVERLAP) -> tuple[Segment, ...]:
    """The segments that make a clip.

    A last segment that is not needed in full gets the last sketch again; its surplus frames are dropped.

    Args:
        frames: of the clip, the reference picture included; 2 or more.
        overlap: frames that neighbouring segments share.
    """
    require("frames", frames, frames >= 2, "2 or more: the reference picture and one to be made")
    segments = [_first(frames, overlap)]
    while _end(segments) < frames:
        segments.append(_later(frames, overlap, segments))
    surplus = _end(segments) - frames
    last = segments[-1]
    if surplus:
        made = last.made[:-surplus]
        segments[-1] = Segment(last.layout, last.sketches, last.carried, last.blended, last.noise, made)
    return tuple(segments)


def _end(segments: list[Segment]) -> int:
    return 1 + sum(len(segment.made) for segment in segments)


def _first(frames: int, overlap: int) -> Segment:
    layout = FrameLayout.first_segment(overlap)
    sketches = _within(frames, [0] * layout.references + list(range(1, 1 + CLIP_FRAMES)))
    slots = tuple(range(layout.count))
    return Segment(layout, sketches, (), (), slots, slots[layout.references :])


def _later(frames: int, overlap: int, before: list[Segment]) -> Segment:
    layout = FrameLayout.later_segment(overlap)
    start, noise = _end(before) - overlap, before[-1].noise
    sketches = [0, *range(start, start + overlap), *range(start, start + CLIP_FRAMES)]
    shared = tuple(range(layout.count - overlap, layout.count))
    return Segment(
        layout,
        _within(frames, sketches),
        shared,
        shared,
        (noise[0], *noise[-overlap:], *noise[-overlap:], *noise[1 + overlap : -overlap]),
        tuple(range(layout.references + overlap, layout.count)),
    )


def _within(frames: int, sketches: list[int]) -> tuple[int, ...]:
    return tuple(min(sketch, frames - 1) for sketch in sketches)
