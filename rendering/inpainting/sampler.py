"""Differential diffusion: each place is freed at the step that its strength says (Levin and Fried, 2023).

With n steps, a place that may change by c follows the noised original until step i with c >= 1 - i / n, and is denoised
freely from then on. c = 1 is free from the beginning, as in plain inpainting; c = 0 never.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import torch
from torch import Tensor

__all__ = ["sample_softly"]


@torch.no_grad()
def sample_softly(
    predict: Callable[[Tensor, Tensor], Tensor],
    scheduler: Any,
    original: Tensor,
    noise: Tensor,
    change: Tensor,
    *,
    steps: int,
    strength: float = 1.0,
    watch: Callable[[], None] | None = None,
) -> Tensor:
    """The latents of a picture, changed as much as each place may be.

    Args:
        predict: the network: what it says of scaled noisy latents at a time, of the latents' shape.
        scheduler: one of diffusers', whose steps do not depend on steps before.
        original: scaled latents of the picture, shape [1, 4, h, w].
        noise: standard normal, of the same shape.
        change: 0..1, shape [1, 1, h, w].
        steps: for the strength 1.
        strength: share of the steps that is done; 1 starts from noise alone, less from the noised original.
        watch: called after each step; may raise to stop.
    """
    scheduler.set_timesteps(steps, device=original.device)
    times = scheduler.timesteps[steps - int(steps * strength) :]
    x = noise * scheduler.init_noise_sigma if strength == 1 else scheduler.add_noise(original, noise, times[:1])
    for done, time in enumerate(times):
        if done:
            free = change >= 1 - done / len(times)
            x = torch.where(free, x, scheduler.add_noise(original, noise, time[None]))
        x = scheduler.step(predict(scheduler.scale_model_input(x, time), time), time, x).prev_sample
        if watch is not None:
            watch()
    return torch.where(change >= 1 / len(times), x, original)
