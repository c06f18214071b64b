"""Losses against numbers that were worked out by hand from the equations."""

from __future__ import annotations

import math

import pytest
import torch
from physanimator.rendering.training.edm_loss import drawn_sigma, edm_loss, edm_weight, noisy_at
from physanimator.rendering.training.velocity_loss import drawn_timestep, noisy_and_velocity, velocity_loss
from torch import Tensor


def clip(*values: float) -> Tensor:
    """One clip of one frame with one channel, and these values in a row."""
    return torch.tensor(values).reshape(1, 1, 1, 1, -1)


def test_noise_is_added_in_the_strength_of_each_clip() -> None:
    clean, noise = torch.zeros(2, 1, 1, 1, 1), torch.ones(2, 1, 1, 1, 1)
    assert noisy_at(clean, noise, torch.tensor([0.5, 3.0])).flatten().tolist() == [0.5, 3.0]


@pytest.mark.parametrize("sigma", [0.02, 1.0, 2.0, 500.0])
def test_the_video_models_loss_is_that_of_its_equation(sigma: float) -> None:
    clean, noisy, output = (0.3, -1.2), (0.9, -0.1), (0.5, 0.7)
    skip, out = 1 / (sigma**2 + 1), -sigma / math.sqrt(sigma**2 + 1)
    squares = [(skip * x + out * f - z) ** 2 for x, f, z in zip(noisy, output, clean, strict=True)]
    expected = (sigma**2 + 1) / sigma**2 * sum(squares) / 2
    found = edm_loss(clip(*output), clip(*noisy), clip(*clean), torch.tensor([sigma]))
    assert float(found) == pytest.approx(expected, rel=1e-5)


def test_the_weight_lets_every_noise_level_count_alike_for_the_network() -> None:
    """A network that is off by 1 has the loss 1, however strong the noise is."""
    for sigma in (0.05, 1.0, 40.0):
        level = torch.tensor([sigma])
        clean, noise = clip(0.4, -0.8), clip(1.1, 0.2)
        noisy = noisy_at(clean, noise, level)
        ideal = (clean - noisy / (sigma**2 + 1)) / (-sigma / math.sqrt(sigma**2 + 1))
        assert float(edm_loss(ideal, noisy, clean, level)) == pytest.approx(0, abs=1e-6)
        assert float(edm_loss(ideal + 1, noisy, clean, level)) == pytest.approx(1, rel=1e-3)
        assert float(edm_weight(level)) == pytest.approx((sigma**2 + 1) / sigma**2)


def test_noise_levels_are_spread_as_lvcd_was_trained() -> None:
    generator = torch.Generator().manual_seed(3)
    logs = torch.stack([drawn_sigma(generator) for _ in range(4000)]).log()
    assert float(logs.mean()) == pytest.approx(1.0, abs=0.1)
    assert float(logs.std()) == pytest.approx(1.6, abs=0.1)


def test_noise_levels_of_a_clip_do_not_depend_on_its_neighbour() -> None:
    both = edm_loss(
        torch.zeros(2, 1, 1, 1, 1), torch.ones(2, 1, 1, 1, 1), torch.zeros(2, 1, 1, 1, 1), torch.tensor([1.0, 2.0])
    )
    alone = edm_loss(clip(0.0), clip(1.0), clip(0.0), torch.tensor([2.0]))
    assert float(both[1]) == pytest.approx(float(alone[0]))


@pytest.mark.parametrize("timestep", [0, 200, 399, 700, 999])
def test_the_interpolations_target_is_the_velocity_of_the_rescaled_latents(timestep: int) -> None:
    beta = torch.linspace(0.00085**0.5, 0.012**0.5, 1000, dtype=torch.float64) ** 2
    root = torch.cumprod(1 - beta, 0).sqrt()
    signal = float((root - root[-1])[timestep] * root[0] / (root[0] - root[-1]))
    scale = 1 - 0.3 * timestep / 399 if timestep < 400 else 0.7
    rest = math.sqrt(1 - signal**2)
    noisy, velocity = noisy_and_velocity(clip(0.6), clip(-1.5), torch.tensor([timestep]))
    assert float(noisy) == pytest.approx(signal * scale * 0.6 + rest * -1.5, abs=1e-5)
    assert float(velocity) == pytest.approx(signal * -1.5 - rest * scale * 0.6, abs=1e-5)
    assert float(velocity_loss(velocity + 0.5, velocity)) == pytest.approx(0.25, rel=1e-4)


def test_the_last_timestep_is_pure_noise() -> None:
    noisy, velocity = noisy_and_velocity(clip(0.6), clip(-1.5), torch.tensor([999]))
    assert float(noisy) == -1.5
    assert float(velocity) == pytest.approx(-0.7 * 0.6)


def test_timesteps_are_drawn_from_all_of_them() -> None:
    generator = torch.Generator().manual_seed(0)
    drawn = torch.stack([drawn_timestep(generator) for _ in range(4000)]).float()
    assert float(drawn.min()) >= 0
    assert float(drawn.max()) <= 999
    assert float(drawn.mean()) == pytest.approx(499.5, abs=20)
