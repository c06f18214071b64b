"""Sampling of a clip's latents, segment after segment (LVCD, Section 3.4)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import torch
from torch import Tensor

from .dual_clock import DualClock
from .frame_layout import OVERLAP, FrameLayout
from .loop_segments import plan_clip
from .noise_schedule import Preconditioning, denoised, euler_step, noise_levels
from .segments import Segment

__all__ = ["LATENT_SCALE", "Predictor", "SampledStep", "sample_clip"]

LATENT_SCALE = 0.18215
"""Sampled latents are the autoencoder's times this; condition latents are the autoencoder's own."""


class Predictor(Protocol):
    """The networks."""

    def __call__(
        self, x: Tensor, condition: Tensor, sketches: Tensor, noise_level: Tensor, layout: FrameLayout
    ) -> Tensor:
        """Predict the velocity of a segment.

        Args:
            x: scaled noisy latents, float32, shape [t, 4, h, w].
            condition: condition latents, shape [t, 4, h, w].
            sketches: lines 1 on 0, shape [t, 3, 8 h, 8 w]; [t, 0] where the networks read none.
            noise_level: ln(sigma) / 4, a scalar.
            layout: the segment's frames.
        """
        ...


@dataclass(frozen=True, eq=False)
class SampledStep:
    """What is known in the middle of the sampling.

    Attributes:
        segment: number of the segment.
        step: number of the step in it.
        done: steps done in all segments, this one included.
        total: steps of all segments.
        noisy: latents before the step, shape [t, 4, h, w].
        clean: denoised latents as predicted in the step, shape [t, 4, h, w].
    """

    segment: int
    step: int
    done: int
    total: int
    noisy: Tensor
    clean: Tensor


@torch.no_grad()
def sample_clip(
    predict: Predictor,
    first_latent: Tensor,
    sketches: Tensor,
    noise: Tensor,
    *,
    sigmas: Tensor | None = None,
    overlap: int = OVERLAP,
    loops: bool = False,
    watch: Callable[[SampledStep], None] | None = None,
    segments: Sequence[Segment] | None = None,
    clock: DualClock | None = None,
) -> Tensor:
    """The latents of all frames.

    Args:
        predict: the networks.
        first_latent: of the reference picture, by the autoencoder, unscaled, shape [1, 4, h, w].
        sketches: of all frames, the reference picture's first; lines 1 on 0, shape [f, 3, 8 h, 8 w];
            [f, 0] where the networks read none.
        noise: standard normal, one for each slot of a segment, shape [15 + overlap, 4, h, w].
        sigmas: noise levels, the last 0; those of 25 steps by default.
        overlap: frames that neighbouring segments share.
        loops: whether the last frame leads to frame 1.
        watch: called in every step; may raise to stop.
        segments: that make the clip; those of LVCD by default.
        clock: an animation that leads as well.

    Returns:
        Scaled latents, the reference picture's first, float32, shape [f, 4, h, w].
    """
    levels = (noise_levels(25) if sigmas is None else sigmas).to(noise.device)
    segments = plan_clip(len(sketches), overlap, loops=loops) if segments is None else segments
    start = 0 if clock is None else clock.weak
    steps = len(levels) - 1 - start
    shown = LATENT_SCALE * first_latent if clock is None else clock.latents[:1]  # those have no noise on the picture
    found, made = _Found(first_latent, noise), [shown]
    opening: _Found | None = None
    for number, segment in enumerate(segments):

        def report(step: int, noisy: Tensor, clean: Tensor, number: int = number) -> None:
            if watch is not None:
                done = number * steps + step - start + 1
                watch(SampledStep(number, step, done, len(segments) * steps, noisy, clean))

        before = found if opening is None or not segment.closes else found.followed_by(opening)
        found = _sample_segment(predict, segment, before, sketches, noise, levels, report, clock)
        if opening is None and segments[-1].closes:
            opening = found
        made.append(found.result[list(segment.made)])
    return torch.cat(made)


@dataclass(frozen=True, eq=False)
class _Found:
    """What one segment leaves to the next.

    Attributes:
        first: latent of the reference picture, unscaled, shape [1, 4, h, w].
        result: scaled latents of all slots; its noise before the first segment.
        clean: denoised latents of all slots in each step that was sampled, before blending.
    """

    first: Tensor
    result: Tensor
    clean: tuple[Tensor, ...] = ()

    def followed_by(self, other: _Found) -> _Found:
        """The slots of both, one after the other."""
        clean = tuple(torch.cat(both) for both in zip(self.clean, other.clean, strict=True))
        return _Found(self.first, torch.cat([self.result, other.result]), clean)


def _sample_segment(
    predict: Predictor,
    segment: Segment,
    before: _Found,
    sketches: Tensor,
    noise: Tensor,
    levels: Tensor,
    report: Callable[[int, Tensor, Tensor], None],
    clock: DualClock | None,
) -> _Found:
    condition, hint = _condition(segment, before), sketches[list(segment.sketches)]
    noise = noise[list(segment.noise)]
    start = 0 if clock is None else clock.weak
    x = noise * (1 + levels[0] ** 2).sqrt() if clock is None else clock.start(segment.sketches, noise, levels[start])
    predictions: list[Tensor] = []
    for step, (sigma, following) in enumerate(pairwise(levels[start:]), start):
        use = Preconditioning.at(sigma)
        clean = denoised(x, predict(use.into * x, condition, hint, use.level, segment.layout), sigma)
        report(step, x, clean)
        predictions.append(clean)
        if segment.blended:
            clean = clean.clone()
            clean[list(segment.held)] = before.clean[step - start][list(segment.blended)]
        x = euler_step(x, clean, sigma, following)
        if clock is not None:
            x = clock.put_back(x, segment.sketches, noise, step, following)
    return _Found(before.first, x, tuple(predictions))


def _condition(segment: Segment, before: _Found) -> Tensor:
    """Condition latents of all slots, shape [t, 4, h, w]."""
    on = segment.conditioned_on
    first = before.first if on is None else before.result[[on]] / LATENT_SCALE
    condition = first.repeat(segment.layout.count, 1, 1, 1)
    if segment.carried:
        condition[1 : 1 + len(segment.carried)] = before.result[list(segment.carried)] / LATENT_SCALE
    return condition
