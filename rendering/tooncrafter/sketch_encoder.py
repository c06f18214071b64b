"""The sketch ControlNet: Stable Diffusion 2.1's encoder with a one-channel sketch, applied to each frame."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from torch import Tensor, nn

from ..networks.checkpoints import network_of
from ..networks.embeddings import embedding_layers, sinusoid
from ..svd.controlnet import hint_layers, zero_convolution
from .configuration import SketchEncoderConfiguration
from .stages import Conditions, input_stages, middle_stage, skip_channels

__all__ = ["SketchEncoder"]


class SketchEncoder(nn.Module):
    """What sketches add to the UNet's skips and middle; nothing at the start of its training."""

    def __init__(self, config: SketchEncoderConfiguration) -> None:
        super().__init__()
        self.config = config
        embedding = config.embedding_channels
        self.time_embed = embedding_layers(config.model_channels, embedding, embedding)
        self.input_blocks = nn.ModuleList(input_stages(config))
        self.middle_block = middle_stage(config)
        self.input_hint_block = nn.Sequential(*hint_layers(config.hint_channels, config.model_channels))
        self.zero_convs = nn.ModuleList(zero_convolution(channels) for channels in skip_channels(config))
        self.middle_block_out = zero_convolution(config.level_channels[-1])

    @classmethod
    def from_reference(
        cls, config: SketchEncoderConfiguration | Mapping[str, Any], state_dict: Mapping[str, Any]
    ) -> SketchEncoder:
        """A network with the weights of a state dict, whose names are the public checkpoint's."""
        return network_of(
            lambda: cls(SketchEncoderConfiguration.of(config)),
            state_dict,
            wanted="weights of ToonCrafter's sketch encoder",
        )

    def forward(self, x: Tensor, hint: Tensor, timestep: Tensor, context: Tensor) -> list[Tensor]:
        """Read the sketches.

        Args:
            x: noisy latents, shape [b * t, 4, h, w].
            hint: sketches, lines 1 on 0, shape [b * t, 1, 8 h, 8 w].
            timestep: of each clip, 0..999, shape [b].
            context: all tokens of each clip, shape [b, l, c].

        Returns:
            One residual for each skip of the UNet, then one for its middle, shapes [b * t, c, h', w'].
        """
        embedding = self.time_embed(sinusoid(timestep, self.config.model_channels).to(x.dtype))
        frames = len(x) // len(context)
        conditions = Conditions(embedding.repeat_interleave(frames, dim=0), (context,), frames)
        h, residuals = x, []
        for number, (stage, convolution) in enumerate(zip(self.input_blocks, self.zero_convs, strict=True)):
            h = stage(h, conditions)
            if number == 0:
                h = h + self.input_hint_block(hint)
            residuals.append(convolution(h))
        return [*residuals, self.middle_block_out(self.middle_block(h, conditions))]
