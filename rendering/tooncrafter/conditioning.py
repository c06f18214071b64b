"""What the networks are told of a pair of keyframes: latents, features, prompt and picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor

from ..networks.checkpoints import CheckpointError
from ..networks.image_encoder import encoder_picture
from .autoencoder import DualReferenceAutoencoder
from .models import WANTED_IMAGE_ENCODER, WANTED_TEXT_ENCODER, ToonCrafterModels
from .resampler import ImageResampler

__all__ = ["LATENT_SCALE", "Context", "KeyframePair", "Tokens", "contexts", "empty_prompt_of", "encode_pair", "look_at"]

LATENT_SCALE = 0.18215
"""Between the autoencoder's latents and those that the networks know."""


@dataclass(frozen=True, eq=False)
class KeyframePair:
    """Two encoded keyframes.

    Attributes:
        condition: their latents in the first and the last frame of a clip, zero between, shape [1, 4, t, h, w].
        references: their features, for the decoder.
    """

    condition: Tensor
    references: list[Tensor]


@dataclass(frozen=True, eq=False)
class Context:
    """Tokens that the UNet's cross-attention looks at, for both halves of classifier-free guidance.

    Attributes:
        conditional, unconditional: l tokens of the prompt, then k of the picture for each of t frames, shape
            [b, l + k t, c] each.
    """

    conditional: Tensor
    unconditional: Tensor


@dataclass(frozen=True, eq=False)
class Tokens:
    """What the picture encoder gives.

    Attributes:
        picture: tokens of each pair's first keyframe, shape [b, n, c].
        nothing: tokens of a plain grey picture, shape [1, n, c].
    """

    picture: Tensor
    nothing: Tensor


def encode_pair(autoencoder: DualReferenceAutoencoder, keyframes: Tensor, noise: Tensor, frames: int) -> KeyframePair:
    """Encode two keyframes.

    Args:
        autoencoder: encodes each picture by itself.
        keyframes: the first and the last, -1..1, shape [2, 3, h, w].
        noise: of the latents, which are drawn from a distribution, shape [2, 4, h / 8, w / 8].
        frames: of the clip.
    """
    moments, references = autoencoder.encode(keyframes, together=1)
    mean, log_variance = moments.chunk(2, dim=1)
    latents = LATENT_SCALE * (mean + (log_variance.clamp(-30, 20) / 2).exp() * noise)
    condition = latents.new_zeros((1, latents.shape[1], frames, *latents.shape[2:]))
    condition[0, :, 0], condition[0, :, -1] = latents[0], latents[1]
    return KeyframePair(condition, references)


def contexts(resampler: ImageResampler, tokens: Tokens, prompt: Tensor, without: Tensor) -> Context:
    """Prompt and picture together.

    Args:
        resampler: from the picture encoder's tokens to those of each frame.
        tokens: of the picture encoder.
        prompt: embedded prompt, shape [1, l, c].
        without: the empty prompt, embedded, shape [1, l, c].
    """
    batch = len(tokens.picture)
    told = torch.cat([prompt.expand(batch, -1, -1), resampler(tokens.picture)], dim=1)
    return Context(told, torch.cat([without, resampler(tokens.nothing)], dim=1).expand(batch, -1, -1))


def look_at(models: ToonCrafterModels, pictures: Sequence[Tensor]) -> Tokens:
    """Tokens of each picture and of a plain grey one, by the models' own picture encoder.

    Args:
        models: whose picture encoder is on the device.
        pictures: -1..1, each of shape [3, h, w].
    """
    encoder = models.image_encoder
    if encoder is None:
        raise CheckpointError(f"No picture encoder: the model's file holds none. Wanted: {WANTED_IMAGE_ENCODER}")
    size = encoder.config.picture
    batch = torch.stack([*pictures, torch.zeros_like(pictures[0])])
    tokens = encoder.tokens(encoder_picture(batch, size).to(models.dtype))
    return Tokens(tokens[:-1], tokens[-1:])


def empty_prompt_of(models: ToonCrafterModels) -> Tensor:
    """The empty prompt, embedded, shape [1, l, c]."""
    if models.empty_prompt is None:
        raise CheckpointError(f"No text encoder: the model's file holds none. Wanted: {WANTED_TEXT_ENCODER}")
    return models.empty_prompt
