"""Properties of the samplers, on velocities whose true end is known."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
import torch
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.tooncrafter.fast_sampler import sample_dpm
from physanimator.rendering.tooncrafter.guidance import guided
from physanimator.rendering.tooncrafter.noise_schedule import latent_scales, sampling_steps, signal_levels
from physanimator.rendering.tooncrafter.sampler import sample_ddim
from torch import Tensor

START = torch.randn((1, 4, 2, 8, 8), generator=torch.Generator().manual_seed(1), dtype=torch.float64)


def gaussian(mean: float, deviation: float) -> Callable[[Tensor, int], Tensor]:
    """The exact velocity for latents that are normally distributed."""
    alphas, scales = signal_levels(), latent_scales()

    def velocity(x: Tensor, timestep: int) -> Tensor:
        # The schedule's own signal, of latents that are scaled down.
        signal, noise = alphas[timestep] ** 0.5, (1 - alphas[timestep]) ** 0.5
        m, s = mean * scales[timestep], deviation * scales[timestep]
        clean = m + signal * s**2 / (signal**2 * s**2 + noise**2) * (x - signal * m)
        return signal * (x - signal * clean) / noise - noise * clean

    return velocity


def no_noise(_: int) -> Tensor:
    raise AssertionError("asked for noise")


def exact(velocity: Callable[[Tensor, int], Tensor]) -> Tensor:
    return sample_ddim(velocity, START, sampling_steps(1000, eta=0), no_noise)


def test_without_noise_the_samples_have_the_distribution() -> None:
    samples = exact(gaussian(0.5, 1.5))
    assert samples.mean() == pytest.approx(float(0.5 + 1.5 * START.mean()), abs=0.03)
    assert samples.std() == pytest.approx(float(1.5 * START.std()), rel=0.03)


@pytest.mark.parametrize("steps", [10, 20])
def test_the_fast_solver_comes_closer_in_as_many_steps(steps: int) -> None:
    velocity = gaussian(0.5, 1.5)
    plan, end = sampling_steps(steps, eta=0), exact(velocity)
    slow = (sample_ddim(velocity, START, plan, no_noise) - end).abs().mean()
    fast = (sample_dpm(velocity, START, plan) - end).abs().mean()
    assert fast < 0.6 * slow


@pytest.mark.parametrize("count", [1, 7, 11, 14, 15, 20, 25, 33, 50, 1000])
def test_no_number_of_steps_gives_nan(count: int) -> None:
    """With eta 1 all noise of the first step is new, and what is left of the old rounds to just below 0."""
    samples = sample_ddim(gaussian(0, 1), START, sampling_steps(count), lambda _: torch.randn_like(START))
    assert samples.isfinite().all()
    assert sampling_steps(count)[0].timestep == 999


def test_steps_fall_to_the_clean_end() -> None:
    steps = sampling_steps(50)
    assert steps[0].alpha == 0
    assert all(a.next_alpha == b.alpha and a.next_scale == b.scale for a, b in pairwise(steps))
    assert steps[-1].next_alpha == signal_levels()[0]
    assert np.all(np.diff(signal_levels()) < 0)
    with pytest.raises(InvalidInputError, match="steps must be 1 to 1000"):
        sampling_steps(0)


def test_guidance_keeps_the_contrast() -> None:
    told, without = START, 0.5 * START + 0.1
    assert guided(told, without, scale=7.5, rescale=1).std() == pytest.approx(float(told.std()))
    torch.testing.assert_close(guided(told, without, scale=1, rescale=0), told)
