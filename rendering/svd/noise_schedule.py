"""Noise levels, preconditioning and Euler steps (Karras et al. 2022, Table 1 and Algorithm 1, without churn)."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

__all__ = ["Preconditioning", "denoised", "euler_step", "noise_levels"]


@dataclass(frozen=True)
class Preconditioning:
    """How the network is used at one noise level; it predicts the velocity.

    Attributes:
        skip: weight of the noisy latents in the denoised ones.
        out: weight of the network's output in them.
        into: factor of the noisy latents before they enter the network.
        level: what the network is told of the noise level.
    """

    skip: Tensor
    out: Tensor
    into: Tensor
    level: Tensor

    @classmethod
    def at(cls, sigma: Tensor) -> Preconditioning:
        """For a noise level, float32, any shape."""
        square = sigma**2 + 1
        return cls(1 / square, -sigma / square.sqrt(), 1 / square.sqrt(), sigma.log() / 4)


def noise_levels(steps: int, *, sigma_min: float = 0.002, sigma_max: float = 700.0, rho: float = 7.0) -> Tensor:
    """Falling noise levels, then 0 (Karras et al., 2022, equation 5), with the ends that SVD was trained for.

    Args:
        steps: number of sampling steps.
        sigma_min: last level before 0.
        sigma_max: first level.
        rho: how much denser the low levels lie.

    Returns:
        float32, shape [steps + 1].
    """
    high, low = sigma_max ** (1 / rho), sigma_min ** (1 / rho)
    levels = torch.linspace(high, low, steps, dtype=torch.float64) ** rho
    return torch.cat([levels, levels.new_zeros(1)]).float()


def denoised(x: Tensor, output: Tensor, sigma: Tensor) -> Tensor:
    """What the network's output says about the clean latents behind noisy ones.

    Args:
        x: noisy latents.
        output: of the network, for ``x`` times the preconditioning's ``into``; same shape.
        sigma: noise level, a scalar.
    """
    condition = Preconditioning.at(sigma)
    return condition.skip * x + condition.out * output


def euler_step(x: Tensor, clean: Tensor, sigma: Tensor, following: Tensor) -> Tensor:
    """From one noise level to the following one, straight towards (or past) the denoised latents."""
    return x + (following - sigma) * (x - clean) / sigma
