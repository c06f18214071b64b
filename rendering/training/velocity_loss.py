"""The loss of the interpolation's ControlNet: predicting velocity (Salimans and Ho 2022; ToonCrafter's configuration).

Clean latents z of a clip are first scaled by r_t ("dynamic rescale": from 1 to 0.7 over the first 400 timesteps), then
noised at a timestep t that all values are alike likely to be, by a schedule that ends in pure noise (Lin et al. 2023):

    x = sqrt(a_t) r_t z + sqrt(1 - a_t) n      v = sqrt(a_t) n - sqrt(1 - a_t) r_t z      loss = mean (F(x, t) - v)^2
"""

from __future__ import annotations

from functools import cache

import torch
from torch import Tensor

from ..tooncrafter.noise_schedule import TIMESTEPS, latent_scales, signal_levels

__all__ = ["drawn_timestep", "noisy_and_velocity", "velocity_loss"]


def drawn_timestep(generator: torch.Generator) -> Tensor:
    """A timestep, 0..999, all alike likely, int64, a scalar."""
    return torch.randint(TIMESTEPS, (), generator=generator)


def noisy_and_velocity(clean: Tensor, noise: Tensor, timestep: Tensor) -> tuple[Tensor, Tensor]:
    """What the network sees, and what it has to give.

    Args:
        clean: scaled latents of clips, shape [b, 4, t, h, w].
        noise: standard normal, same shape.
        timestep: of each clip, 0..999, shape [b].

    Returns:
        Noisy latents x and velocity v, same shape each.
    """
    signal, scale = (table.to(clean.device)[timestep].reshape(-1, 1, 1, 1, 1) for table in _schedule())
    scaled = scale * clean
    root, rest = signal.sqrt(), (1 - signal).sqrt()
    return root * scaled + rest * noise, root * noise - rest * scaled


def velocity_loss(output: Tensor, velocity: Tensor) -> Tensor:
    """The squared error of the predicted velocity, averaged over each clip, shape [b]."""
    return (output.float() - velocity.float()).square().flatten(1).mean(1)


@cache
def _schedule() -> tuple[Tensor, Tensor]:
    """Share of the signal's variance, and scale of the latents, at each timestep; float32, shape [1000] each."""
    return torch.from_numpy(signal_levels()).float(), torch.from_numpy(latent_scales()).float()
