"""How much noise there is at each step (Lin et al. 2023, "Common diffusion noise schedules ... are flawed").

The schedule ends in pure noise ("zero terminal SNR"), sampling starts there ("trailing" spacing), and the latents
themselves shrink on the way to the noise ("dynamic rescale", DynamiCrafter).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require

__all__ = ["TIMESTEPS", "SamplingStep", "latent_scales", "sampling_steps", "signal_levels"]

TIMESTEPS = 1000
"""Noise levels that the networks were trained with."""

# Variance of the noise that the first and the last timestep add, as in Stable Diffusion.
_FIRST_BETA, _LAST_BETA = 0.00085, 0.012
# Latents are scaled down to the first of these over so many timesteps, as DynamiCrafter was trained.
_SMALLEST_SCALE, _SCALED_UNTIL = 0.7, 400

Numbers = NDArray[np.float64]


@dataclass(frozen=True)
class SamplingStep:
    """From one noise level to the next.

    Attributes:
        timestep: 0..999; 999 is pure noise.
        alpha: share of the signal's variance in the noisy latents here, 0..1.
        next_alpha: the same after the step.
        scale: of the clean latents here.
        next_scale: the same after the step.
        sigma: standard deviation of the noise that the step adds.
    """

    timestep: int
    alpha: float
    next_alpha: float
    scale: float
    next_scale: float
    sigma: float


def signal_levels() -> Numbers:
    """Share of the signal's variance at each timestep, falling to exactly 0, shape [1000]."""
    betas = np.linspace(_FIRST_BETA**0.5, _LAST_BETA**0.5, TIMESTEPS) ** 2
    root = np.sqrt(np.cumprod(1 - betas))
    return ((root - root[-1]) * root[0] / (root[0] - root[-1])) ** 2


def latent_scales() -> Numbers:
    """Scale of the clean latents at each timestep, shape [1000]."""
    falling = np.linspace(1, _SMALLEST_SCALE, _SCALED_UNTIL)
    return np.concatenate([falling, np.full(TIMESTEPS - _SCALED_UNTIL, _SMALLEST_SCALE)])


def sampling_steps(count: int, *, eta: float = 1.0) -> list[SamplingStep]:
    """The steps from pure noise to clean latents.

    Args:
        count: number of steps.
        eta: share of the noise that is drawn anew in each step, 0 (none: deterministic) to 1.
    """
    require("steps", count, 1 <= count <= TIMESTEPS, f"1 to {TIMESTEPS}")
    require("eta", eta, 0 <= eta <= 1, "0 to 1")
    alphas, scales = signal_levels(), latent_scales()
    times = [round(TIMESTEPS - number * TIMESTEPS / count) - 1 for number in range(count)]
    steps = []
    for number, time in enumerate(times):
        last = number + 1 == count
        alpha, next_alpha = alphas[time], alphas[0 if last else times[number + 1]]
        next_scale = scales[time] if last else scales[times[number + 1]]
        # The clean end is not quite clean: the last step stays at the first noise level.
        variance = (1 - next_alpha) / (1 - alpha) * (1 - alpha / next_alpha) if alpha < next_alpha else 0.0
        numbers = (alpha, next_alpha, scales[time], next_scale, eta * variance**0.5)
        steps.append(SamplingStep(time, *map(float, numbers)))
    return steps
