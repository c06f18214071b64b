"""Which of a segment's frames are references, and whose keys each frame attends to (LVCD, Sections 3.2 and 3.4).

Stable Video Diffusion makes 14 frames at once, the clip. LVCD puts reference frames before them, which do not move:
temporal layers leave each of them alone, and all stand at the time of the first clip frame. In space, every frame
attends to its own tokens and to those of a reference frame. A later segment of a long clip begins with the last frames
of the segment before: its first frames attend to these, the others to frames a little earlier than themselves.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log

from ...physics.errors import require

__all__ = ["CLIP_FRAMES", "LEAST_OVERLAP", "OVERLAP", "FrameLayout", "KeyFrames"]

CLIP_FRAMES = 14
"""Frames that the network was trained to make together."""

OVERLAP = 4
"""Frames that one segment shares with the next in LVCD."""

LEAST_OVERLAP = 3
"""So many frames before themselves lie the keys of a later segment's new frames."""


@dataclass(frozen=True)
class KeyFrames:
    """A run of successive frames and the frames whose tokens they attend to, in one softmax.

    Attributes:
        own: frame of the first half of the keys, for each frame of the run.
        reference: frame of the second half, for each; empty where both halves are the same.
        bias: added to the logits of the second half.
    """

    own: tuple[int, ...]
    reference: tuple[int, ...] = ()
    bias: float = 0.0


@dataclass(frozen=True)
class FrameLayout:
    """The frames of one segment.

    Attributes:
        references: number of reference frames, which come first; ``CLIP_FRAMES`` at most follow.
        runs: the key frames of all frames, in order.
    """

    references: int
    runs: tuple[KeyFrames, ...]

    @property
    def count(self) -> int:
        """Number of frames."""
        return sum(len(run.own) for run in self.runs)

    @property
    def times(self) -> tuple[int, ...]:
        """Time of each frame in its clip: 0 for all references and for the first clip frame."""
        return tuple(max(frame - self.references, 0) for frame in range(self.count))

    @classmethod
    def single_reference(cls, count: int) -> FrameLayout:
        """As in training: every frame attends to itself and to frame 0.

        Args:
            count: number of frames; those beyond ``CLIP_FRAMES`` are references.
        """
        require("count", count, count >= 1, "at least 1 frame")
        others = tuple(range(1, count))
        runs = (KeyFrames((0,)), KeyFrames(others, (0,) * len(others)))
        return cls(max(count - CLIP_FRAMES, 0), runs if others else runs[:1])

    @classmethod
    def plain(cls) -> FrameLayout:
        """Stable Video Diffusion's own clip: no references, and every frame attends to itself."""
        return cls(0, (KeyFrames(tuple(range(CLIP_FRAMES))),))

    @classmethod
    def first_segment(cls, overlap: int = OVERLAP) -> FrameLayout:
        """The first segment of a clip: 1 + overlap references, which attend to themselves only."""
        references = _references(overlap)
        clip = tuple(range(references, references + CLIP_FRAMES))
        return cls(references, (KeyFrames(tuple(range(references))), KeyFrames(clip, (0,) * CLIP_FRAMES)))

    @classmethod
    def later_segment(cls, overlap: int = OVERLAP, *, amplification: float = 10.0) -> FrameLayout:
        """A segment that goes on from the one before.

        Args:
            overlap: frames of the segment before, which are references 1 to overlap and clip frames once more.
            amplification: so many times counts a token of the frame before, for the frames made once more.
        """
        references = _references(overlap)
        again, new = range(references, references + overlap), range(references + overlap, references + CLIP_FRAMES)
        runs = (
            KeyFrames(tuple(range(references))),
            KeyFrames(tuple(again), tuple(frame - overlap for frame in again), log(amplification)),
            KeyFrames(tuple(frame - LEAST_OVERLAP for frame in new), (0,) * len(new)),
        )
        return cls(references, runs)


def _references(overlap: int) -> int:
    require("overlap", overlap, LEAST_OVERLAP <= overlap < CLIP_FRAMES, f"{LEAST_OVERLAP} to {CLIP_FRAMES - 1} frames")
    return 1 + overlap
