"""Sampling: from noise to clean latents (DDIM, Song et al. 2021), with velocity prediction (Salimans and Ho 2022)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from torch import Tensor

from .noise_schedule import SamplingStep

__all__ = ["SampledStep", "Velocity", "sample_ddim"]

Velocity = Callable[[Tensor, int], Tensor]
"""Predicts the guided velocity of noisy latents at a timestep."""

Noise = Callable[[int], Tensor]
"""Noise of the latents' shape for a step, by its number."""

Watch = Callable[["SampledStep"], None]


@dataclass(frozen=True, eq=False)
class SampledStep:
    """What is known during a step.

    Attributes:
        number: of the step, from 0.
        noisy: latents before it.
        clean: the latents that it predicts, on the scale of the next step.
    """

    number: int
    noisy: Tensor
    clean: Tensor


def sample_ddim(
    velocity: Velocity, start: Tensor, steps: Sequence[SamplingStep], noise: Noise, *, watch: Watch | None = None
) -> Tensor:
    """Clean latents from noise, step by step (DDIM).

    Args:
        velocity: the network, with guidance.
        start: pure noise.
        steps: from ``sampling_steps``.
        noise: drawn anew in each step that has some.
        watch: called in each step; may raise to stop.

    Returns:
        Clean latents, scaled as the networks know them.
    """
    x = start
    for number, step in enumerate(steps):
        clean, direction = split_velocity(x, velocity(x, step.timestep), step)
        clean = clean * (step.next_scale / step.scale)
        if watch is not None:
            watch(SampledStep(number, x, clean))
        # Never below 0 but for rounding, where all noise is new.
        kept = max(1 - step.next_alpha - step.sigma**2, 0.0) ** 0.5
        x = step.next_alpha**0.5 * clean + kept * direction
        if step.sigma > 0:
            x = x + step.sigma * noise(number)
    return x


def split_velocity(x: Tensor, velocity: Tensor, step: SamplingStep) -> tuple[Tensor, Tensor]:
    """Clean latents and noise that the noisy latents are made of, by the predicted velocity."""
    signal, noise = step.alpha**0.5, (1 - step.alpha) ** 0.5
    return signal * x - noise * velocity, signal * velocity + noise * x
