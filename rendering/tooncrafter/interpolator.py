"""The interpolation as a backend: in-betweens of a clip's keyframes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import torch
from numpy.typing import NDArray

from ...physics.progress import Progress
from ..inbetweens import Clip, FloatImage, ModelFile
from ..networks.checkpoints import CheckpointError
from ..networks.placement import Placement
from ..pictures import as_dtype
from ..pictures.colour_matching import colours_of, common_weights, with_colours
from .gap_drawing import Gap, GapDrawing
from .gap_plan import clips_in
from .models import WANTED_SKETCH, ToonCrafterModels
from .options import ToonCrafterOptions
from .pair_drawing import LookAt, PairDrawing, Prompts
from .sampler import SampledStep, Watch

__all__ = ["ToonCrafterInterpolator"]


class ToonCrafterInterpolator:
    """Draws in-betweens as ToonCrafter does; where the clip has sketches, they lead it."""

    name = "tooncrafter"
    description = "Draws in-betweens with the video model ToonCrafter, led by sketches: for large or unknown motion"
    requires: tuple[ModelFile, ...] = ()

    def __init__(
        self,
        models: ToonCrafterModels,
        *,
        options: ToonCrafterOptions | None = None,
        placement: Placement | None = None,
        look: LookAt | None = None,
        prompts: Prompts | None = None,
        progress: Progress | None = None,
        watch: Watch | None = None,
        colour_match: float = 1.0,
    ) -> None:
        """Prepare.

        Args:
            models: the networks.
            options: settings.
            placement: where the networks compute; on the CPU by default.
            look: another picture encoder than the models' own.
            prompts: what is wanted, and no words at all, by another text encoder than that of the models' files.
            progress: called after each sampling step with the number done and the number in all, counted for each pair
                of keyframes; may raise to stop.
            watch: called in each sampling step; may raise to stop.
            colour_match: share of the colour drift that is taken out, 0..1: in-betweens get what lies between the
                colours of their keyframes.
        """
        self.options = options or ToonCrafterOptions()
        place = placement or Placement(torch.device("cpu"))
        self._drawing = PairDrawing(models, self.options, place, look=look, prompts=prompts)
        self._progress, self._watch, self._colour_match = progress, watch, colour_match
        self._clip: Clip | None = None
        self._drawn: dict[int, dict[int, FloatImage]] = {}
        self._done = 0

    def in_betweens(self, clip: Clip, number: int) -> Iterator[NDArray[Any]]:
        """Yield the frames between two keyframes; those of pairs that were drawn with it wait for their turn."""
        if clip is not self._clip:
            self._clip, self._drawn, self._done = clip, {}, 0
        if number not in self._drawn:
            last = min(number + self.options.pairs_together, len(clip.keyframes) - 1)
            self._drawn = self._filled(clip, range(number, last))
        drawn = self._drawn.pop(number)
        for picture in self._matched(clip, number, drawn):
            yield as_dtype(picture, clip.keyframes[number].dtype)

    def _matched(self, clip: Clip, number: int, drawn: dict[int, FloatImage]) -> Iterator[FloatImage]:
        """The frames between two keyframes, with colours between theirs."""
        ends = [clip.keyframe(number), clip.keyframe(number + 1)]
        first, last = (colours_of(end, common_weights(end)) for end in ends)
        for frame, place in clip.times(number):
            picture = drawn[frame]
            found = colours_of(picture, common_weights(picture))
            yield with_colours(picture, found, first.towards(last, place), amount=self._colour_match)

    def _filled(self, clip: Clip, numbers: range) -> dict[int, dict[int, FloatImage]]:
        """In-betweens of several pairs of keyframes."""
        sketches = clip.sketches if self.options.control_scale > 0 else ()
        if sketches and self._drawing.models.sketch is None:
            raise CheckpointError(
                f"Sketches lead the in-betweens only with a model of their own. Wanted: {WANTED_SKETCH}"
            )
        clip_gap = self._drawing.models.unet.config.temporal_length - 1
        lengths = [last - first for first, last in zip(clip.indices, clip.indices[1:], strict=False)]
        total = self.options.steps * sum(clips_in(length, clip_gap) for length in lengths)

        def each_step(now: SampledStep) -> None:
            if self._watch is not None:
                self._watch(now)
            self._done += len(now.noisy)
            if self._progress is not None:
                self._progress(self._done, total)

        drawing = GapDrawing(self._drawing, sketches, clip.size, watch=each_step)
        return dict(zip(numbers, drawing.filled([_gap(clip, number) for number in numbers]), strict=True))


def _gap(clip: Clip, number: int) -> Gap:
    start, end = clip.keyframe(number), clip.keyframe(number + 1)
    return Gap(clip.indices[number], clip.indices[number + 1], start, end)
