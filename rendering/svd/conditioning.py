"""What the networks are told of the illustration (Blattmann et al. 2023, Stable Video Diffusion, Section 4)."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from ..networks.image_encoder import encoder_picture
from ..networks.memory import autoencoder_bytes
from ..networks.placement import Placement
from .models import SVDModels
from .options import SVDOptions

__all__ = ["Conditioning", "condition_on"]


@dataclass(frozen=True, eq=False)
class Conditioning:
    """On the device.

    Attributes:
        context: what the picture shows, shape [1, 1, c].
        latent: of the picture, unscaled, float32, shape [1, 4, h, w].
        ids: frames per second, motion bucket and noise of the picture, float32, shape [1, 3].
    """

    context: Tensor
    latent: Tensor
    ids: Tensor


@torch.no_grad()
def condition_on(
    picture: Tensor,
    models: SVDModels,
    *,
    options: SVDOptions,
    placement: Placement,
    generator: torch.Generator,
) -> Conditioning:
    """Encode the reference picture.

    Args:
        picture: 0..1, shape [1, 3, H, W].
        models: whose encoders are used.
        options: settings.
        placement: where to compute.
        generator: of the noise on the picture.
    """
    device, picture = placement.device, 2 * picture - 1
    with placement.at_work(models.image_encoder):
        small = encoder_picture(picture, models.image_encoder.config.picture)
        context = models.image_encoder(small.to(device, models.dtype))[:, None]
    if options.picture_noise:
        picture = picture + options.picture_noise * torch.randn(picture.shape, generator=generator)
    channels = models.autoencoder.config.block_out_channels[0]
    with placement.at_work(models.autoencoder, working_bytes=autoencoder_bytes(picture[0, 0].numel(), channels)):
        latent = models.autoencoder.encode(picture.to(device)).latent_dist.mode()
    numbers = (options.frames_per_second, options.motion_bucket, options.picture_noise)
    return Conditioning(context, latent, torch.tensor([numbers], dtype=torch.float32, device=device))
