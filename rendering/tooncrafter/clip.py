"""Drawing one clip, or several at once, between pairs of keyframes: the networks and the sampler together."""

from __future__ import annotations

import torch
from torch import Tensor

from .conditioning import Context
from .fast_sampler import sample_dpm
from .guidance import guided
from .models import ToonCrafterModels
from .noise_schedule import sampling_steps
from .options import ToonCrafterOptions
from .sampler import Noise, Velocity, Watch, sample_ddim

__all__ = ["guided_velocity", "sample_clips"]


def guided_velocity(
    models: ToonCrafterModels,
    condition: Tensor,
    context: Context,
    hints: Tensor | None,
    options: ToonCrafterOptions,
) -> Velocity:
    """The networks as one function of noisy latents and timestep.

    Args:
        models: whose UNet (and sketch encoder) are on the device.
        condition: latents of the keyframes, shape [b, 4, t, h, w].
        context: prompt and picture.
        hints: sketches, lines 1 on 0, shape [b, 1, t, 8 h, 8 w]; None for no control.
        options: settings.
    """
    dtype, device, batch = models.dtype, condition.device, len(condition)
    rate = torch.full((batch,), options.frame_rate, device=device)
    controlled = hints is not None and options.control_scale > 0
    frames_of_hints = hints.transpose(1, 2).flatten(0, 1).to(device, dtype) if hints is not None else None

    def predict(x: Tensor, timestep: Tensor, asked: Tensor) -> Tensor:
        control = None
        if controlled:
            assert models.sketch is not None
            assert frames_of_hints is not None
            residuals = models.sketch(x.transpose(1, 2).flatten(0, 1).to(dtype), frames_of_hints, timestep, asked)
            control = [options.control_scale * each for each in residuals]
        both = torch.cat([x, condition], dim=1).to(dtype)
        return models.unet(both, timestep, asked, rate, control).float()

    def velocity(x: Tensor, timestep: int) -> Tensor:
        time = torch.full((batch,), timestep, device=device)
        told = predict(x, time, context.conditional)
        if options.guidance == 1:
            return told
        without = predict(x, time, context.unconditional)
        return guided(told, without, scale=options.guidance, rescale=options.guidance_rescale)

    return velocity


@torch.no_grad()
def sample_clips(
    velocity: Velocity, start: Tensor, noise: Noise, options: ToonCrafterOptions, *, watch: Watch | None = None
) -> Tensor:
    """Clean, scaled latents of clips, shape [b, 4, t, h, w], from noise of that shape."""
    if options.solver == "dpm++ 2m":
        return sample_dpm(velocity, start, sampling_steps(options.steps, eta=0), watch=watch)
    return sample_ddim(velocity, start, sampling_steps(options.steps, eta=options.eta), noise, watch=watch)
