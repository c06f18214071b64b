"""The loss of the video model's ControlNet: denoising over noise levels (Karras et al. 2022, Section 5; LVCD).

A clip of clean latents z gets noise of one level, x = z + s n with ln s ~ N(1.0, 1.6) and n standard normal. The
network F sees c_in x and gives D = c_skip x + c_out F; the loss is the mean of w (D - z)^2 with

    c_skip = 1 / (s^2 + 1)    c_out = -s / sqrt(s^2 + 1)    c_in = 1 / sqrt(s^2 + 1)    w = (s^2 + 1) / s^2

so that w c_out^2 = 1: every noise level counts alike for what the network itself has to give.
"""

from __future__ import annotations

import torch
from torch import Tensor

from ..svd.noise_schedule import denoised

__all__ = ["MEAN_LOG_SIGMA", "STD_LOG_SIGMA", "drawn_sigma", "edm_loss", "edm_weight", "noisy_at"]

MEAN_LOG_SIGMA, STD_LOG_SIGMA = 1.0, 1.6
"""Of the normal distribution of ln s, as LVCD was trained."""


def drawn_sigma(generator: torch.Generator, *, mean: float = MEAN_LOG_SIGMA, std: float = STD_LOG_SIGMA) -> Tensor:
    """One noise level, float32, a scalar.

    Args:
        generator: of the chance.
        mean, std: of its logarithm.
    """
    return (mean + std * torch.randn((), generator=generator)).exp()


def noisy_at(clean: Tensor, noise: Tensor, sigma: Tensor) -> Tensor:
    """Latents with noise of one level.

    Args:
        clean: scaled latents, shape [b, t, 4, h, w].
        noise: standard normal, same shape.
        sigma: noise level of each clip, shape [b].
    """
    return clean + _of_clips(sigma) * noise


def edm_weight(sigma: Tensor) -> Tensor:
    """w = (s^2 + 1) / s^2 of noise levels of any shape."""
    return (sigma**2 + 1) / sigma**2


def edm_loss(output: Tensor, noisy: Tensor, clean: Tensor, sigma: Tensor) -> Tensor:
    """The weighted squared error of the denoised latents, averaged over each clip, shape [b].

    Args:
        output: of the network, for c_in times ``noisy``; shape [b, t, 4, h, w].
        noisy: from :func:`noisy_at`.
        clean: scaled latents.
        sigma: noise level of each clip, shape [b].
    """
    error = denoised(noisy.float(), output.float(), _of_clips(sigma)) - clean.float()
    return edm_weight(sigma) * error.square().flatten(1).mean(1)


def _of_clips(values: Tensor) -> Tensor:
    return values.reshape(-1, 1, 1, 1, 1)
