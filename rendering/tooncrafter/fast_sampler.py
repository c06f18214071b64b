"""Sampling in fewer steps: DPM-Solver++ of second order with two steps' memory (Lu et al. 2022), without new noise.

The latents shrink with the noise level ("dynamic rescale"), so that the signal's share in a step is that of the
schedule times the scale; with it, and without memory, the solver is DDIM with eta 0. diffusers' own solver knows no
such scale, and no level of pure noise.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import log

from torch import Tensor

from .noise_schedule import SamplingStep
from .sampler import SampledStep, Velocity, Watch, split_velocity

__all__ = ["sample_dpm"]


def sample_dpm(
    velocity: Velocity, start: Tensor, steps: Sequence[SamplingStep], *, watch: Watch | None = None
) -> Tensor:
    """Clean latents from noise in few steps (DPM-Solver++).

    Args:
        velocity: the network, with guidance.
        start: pure noise.
        steps: from ``sampling_steps``.
        watch: called in each step; may raise to stop.

    Returns:
        Clean latents, scaled as the networks know them.
    """
    x, before, before_width = start, None, 0.0
    for number, step in enumerate(steps):
        clean = split_velocity(x, velocity(x, step.timestep), step)[0] / step.scale
        if watch is not None:
            watch(SampledStep(number, x, clean * step.next_scale))
        signal, next_signal = step.alpha**0.5 * step.scale, step.next_alpha**0.5 * step.next_scale
        shrinking = ((1 - step.next_alpha) / (1 - step.alpha)) ** 0.5
        aim, width = clean, 0.0
        # Pure noise lies infinitely far from the next level, so that the first step and the one behind it have no
        # memory; and the last step, which leaves almost no noise, is steadier without.
        if signal > 0:
            width = _signal_to_noise(next_signal, step.next_alpha) - _signal_to_noise(signal, step.alpha)
            if before is not None and before_width > 0 and number + 1 < len(steps):
                aim = clean + width / (2 * before_width) * (clean - before)
        x = shrinking * x + (next_signal - signal * shrinking) * aim
        before, before_width = clean, width
    return x


def _signal_to_noise(signal: float, alpha: float) -> float:
    return log(signal / (1 - alpha) ** 0.5)
