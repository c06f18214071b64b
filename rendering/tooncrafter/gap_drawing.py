"""Frames between keyframes of any size and any distance, from clips of one size and length."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from ..inbetweens import FloatImage
from ..networks import Frame
from ..pictures import as_grey
from .gap_plan import drawn_in_clip, inner_keyframes, sketched_in_clip
from .pair_drawing import Pair, PairDrawing
from .sampler import Watch

__all__ = ["Gap", "GapDrawing"]

Drawn = dict[int, FloatImage]
"""Pictures by frame number."""


@dataclass(frozen=True, eq=False)
class Gap:
    """Two keyframes and the frames between them.

    Attributes:
        first: frame number of the first keyframe.
        last: frame number of the last one.
        start: the first keyframe, 0..1, shape [h, w, 3].
        end: the last keyframe.
    """

    first: int
    last: int
    start: FloatImage
    end: FloatImage

    @property
    def length(self) -> int:
        """Frames from one keyframe to the next."""
        return self.last - self.first


class GapDrawing:
    """Fills gaps between keyframes of one clip."""

    def __init__(
        self,
        drawing: PairDrawing,
        sketches: Sequence[NDArray[Any]],
        size: tuple[int, int],
        *,
        watch: Watch | None = None,
    ) -> None:
        """Prepare.

        Args:
            drawing: draws clips.
            sketches: dark lines on white, for each frame of the clip; none without control.
            size: width and height of the keyframes [px].
            watch: called in each sampling step.
        """
        self._drawing, self._sketches, self._watch = drawing, sketches, watch
        self._frame = Frame.around(*size, area=drawing.options.area)
        self._clip_gap = drawing.models.unet.config.temporal_length - 1

    def filled(self, gaps: Sequence[Gap]) -> list[Drawn]:
        """The frames inside each gap; gaps are drawn together as the options say."""
        found: list[Drawn] = [{} for _ in gaps]
        open_gaps = [(gap, drawn) for gap, drawn in zip(gaps, found, strict=True) if gap.length > 1]
        together = self._drawing.options.pairs_together
        for start in range(0, len(open_gaps), together):
            self._fill(open_gaps[start : start + together])
        return found

    def _fill(self, batch: Sequence[tuple[Gap, Drawn]]) -> None:
        clips = self._drawing.frames([self._pair(gap) for gap, _ in batch], watch=self._watch)
        for (gap, drawn), clip in zip(batch, clips, strict=True):
            inner = inner_keyframes(gap.length, self._clip_gap)
            for frame in inner or range(1, gap.length):
                drawn[gap.first + frame] = self._outward(clip[drawn_in_clip(frame, gap.length, self._clip_gap)])
            if inner:
                for part in self.filled(list(_parts(gap, inner, drawn))):
                    drawn |= part

    def _pair(self, gap: Gap) -> Pair:
        keyframes = torch.stack([self._inward(gap.start), self._inward(gap.end)])
        # The length tells a gap from its own first part.
        return Pair(keyframes, self._hints(gap), (self._drawing.options.seed, gap.first, gap.length))

    def _hints(self, gap: Gap) -> Tensor | None:
        """Lines 1 on 0, shape [1, t, h, w]."""
        if not self._sketches:
            return None
        frames = [gap.first + frame for frame in sketched_in_clip(gap.length, self._clip_gap)]
        framed = [self._frame.inward(as_grey(self._sketches[frame])) for frame in frames]
        return torch.from_numpy(1 - np.stack(framed))[None]

    def _inward(self, picture: FloatImage) -> Tensor:
        return torch.from_numpy(2 * self._frame.inward(picture) - 1).permute(2, 0, 1)

    def _outward(self, picture: Tensor) -> FloatImage:
        return self._frame.outward(((picture + 1) / 2).permute(1, 2, 0).contiguous().numpy())


def _parts(gap: Gap, inner: Sequence[int], drawn: Drawn) -> Sequence[Gap]:
    ends = {gap.first: gap.start, gap.last: gap.end, **drawn}
    frames = [gap.first, *(gap.first + frame for frame in inner), gap.last]
    return [Gap(before, after, ends[before], ends[after]) for before, after in pairwise(frames)]
