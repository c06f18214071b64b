"""The UNet that draws a clip between two keyframes, under the names of its public checkpoint."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import torch
from torch import Tensor, nn

from ..networks.checkpoints import network_of
from ..networks.embeddings import embedding_layers, sinusoid
from ..svd.residual_block import normalised
from .configuration import UNetConfiguration
from .stages import Conditions, Stage, input_stages, middle_stage, output_stages
from .transformer import TemporalTransformer

__all__ = ["InterpolationUNet"]


class InterpolationUNet(nn.Module):
    """Predicts the velocity of the noisy latents of a clip."""

    prefix = "model.diffusion_model."
    """Before its names in the public checkpoint."""

    def __init__(self, config: UNetConfiguration) -> None:
        super().__init__()
        self.config = config
        width, embedding = config.model_channels, config.embedding_channels
        self.time_embed = embedding_layers(width, embedding, embedding)
        self.fps_embedding = embedding_layers(width, embedding, embedding)
        first = TemporalTransformer.convolutional(width, config.num_head_channels, config.init_attn_heads)
        self.init_attn = Stage([first])
        self.input_blocks = nn.ModuleList(input_stages(config))
        self.middle_block = middle_stage(config)
        self.output_blocks = nn.ModuleList(output_stages(config))
        self.out = nn.Sequential(normalised(width), nn.SiLU(), nn.Conv2d(width, config.out_channels, 3, padding=1))

    @classmethod
    def from_reference(
        cls, config: UNetConfiguration | Mapping[str, Any], state_dict: Mapping[str, Any]
    ) -> InterpolationUNet:
        """A network with the weights of a state dict, whose names are the public checkpoint's, prefix included."""
        return network_of(
            lambda: cls(UNetConfiguration.of(config)),
            state_dict,
            wanted="weights of ToonCrafter's UNet",
            prefix=cls.prefix,
        )

    def forward(
        self,
        x: Tensor,
        timestep: Tensor,
        context: Tensor,
        frame_rate: Tensor | None = None,
        control: Sequence[Tensor] | None = None,
    ) -> Tensor:
        """Predict.

        Args:
            x: noisy latents, then condition latents, shape [b, 8, t, h, w].
            timestep: of each clip, 0..999, shape [b].
            context: the prompt's tokens, then those of the picture for each frame, shape [b, l + k t, c].
            frame_rate: of each clip [1/s], shape [b]; the configuration's by default.
            control: what the sketch encoder adds to the skips and, last, to the middle; shapes [b * t, c, h', w'].

        Returns:
            The prediction, shape [b, 4, t, h, w].
        """
        frames = x.shape[2]
        conditions = self._conditions(timestep, context, frame_rate, frames)
        h, skips = x.transpose(1, 2).flatten(0, 1), []
        for number, stage in enumerate(self.input_blocks):
            h = stage(h, conditions)
            if number == 0:
                h = self.init_attn(h, conditions)
            skips.append(h)
        h = self.middle_block(h, conditions)
        if control is not None:
            skips = [skip + each for skip, each in zip(skips, control[:-1], strict=True)]
            h = h + control[-1]
        for stage in self.output_blocks:
            h = stage(torch.cat([h, skips.pop()], dim=1), conditions)
        return self.out(h).unflatten(0, (-1, frames)).transpose(1, 2)

    def _conditions(self, timestep: Tensor, context: Tensor, frame_rate: Tensor | None, frames: int) -> Conditions:
        config, dtype = self.config, context.dtype
        if frame_rate is None:
            frame_rate = torch.full_like(timestep, config.default_fs)
        embedding = self.time_embed(sinusoid(timestep, config.model_channels).to(dtype))
        embedding = embedding + self.fps_embedding(sinusoid(frame_rate, config.model_channels).to(dtype))
        prompt, pictures = context[:, : config.text_tokens], context[:, config.text_tokens :]
        pictures = pictures.reshape(len(context) * frames, config.image_tokens_per_frame, -1)
        return Conditions(embedding.repeat_interleave(frames, dim=0), (prompt, pictures), frames)
