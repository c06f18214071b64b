"""The UNet of Stable Video Diffusion with LVCD's changes, under the names of its public checkpoint."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import torch
from torch import Tensor, nn
from torch.nn import functional

from ..networks.checkpoints import network_of
from .configuration import NetworkConfiguration
from .encoder import SpatioTemporalEncoder, Stage, residual_block, transformer
from .frame_layout import FrameLayout
from .residual_block import normalised

__all__ = ["SpatioTemporalUNet", "Upsample"]


class Upsample(nn.Module):
    """Twice the height and width: every pixel repeated, then a convolution."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.conv = nn.Conv2d(channels, channels, 3, padding=1)

    def forward(self, x: Tensor) -> Tensor:
        return self.conv(functional.interpolate(x, scale_factor=2.0, mode="nearest"))


class SpatioTemporalUNet(SpatioTemporalEncoder):
    """Predicts the velocity of the noisy latents of a segment."""

    prefix = "model.diffusion_model."
    """Before its names in the public checkpoints."""

    def __init__(self, config: NetworkConfiguration) -> None:
        super().__init__(config)
        self.output_blocks = nn.ModuleList(_output_stages(config, self.skip_channels))
        width = config.model_channels
        self.out = nn.Sequential(normalised(width), nn.SiLU(), nn.Conv2d(width, config.out_channels, 3, padding=1))

    @classmethod
    def from_reference(
        cls, config: NetworkConfiguration | Mapping[str, Any], state_dict: Mapping[str, Any]
    ) -> SpatioTemporalUNet:
        """A network with the weights of a state dict, whose names are the public checkpoint's, prefix included."""
        return network_of(
            lambda: cls(NetworkConfiguration.of(config)),
            state_dict,
            wanted="weights of the video UNet",
            prefix=cls.prefix,
        )

    def forward(
        self,
        x: Tensor,
        noise_level: Tensor,
        context: Tensor,
        ids: Tensor,
        layout: FrameLayout,
        control: Sequence[Tensor] | None = None,
    ) -> Tensor:
        """Predict.

        Args:
            x: scaled noisy latents, then condition latents, shape [b, t, 8, h, w].
            noise_level: ln(sigma) / 4 of each video, shape [b].
            context: embedding of each video's picture, shape [b, l, c].
            ids: frames per second, motion bucket and noise of the picture, shape [b, 3].
            layout: the segment's frames.
            control: what the ControlNet adds to the skips and, last, to the middle; shapes [b * t, c, h', w'].

        Returns:
            The prediction, shape [b, t, 4, h, w].
        """
        conditions = self.conditions(noise_level, context, ids, layout)
        skips, h = self.encode(x.flatten(0, 1), conditions)
        if control is not None:
            skips = [skip + each for skip, each in zip(skips, control[:-1], strict=True)]
            h = h + control[-1]
        for stage in self.output_blocks:
            h = stage(torch.cat([h, skips.pop()], dim=1), conditions)
        return self.out(h).unflatten(0, x.shape[:2])


def _output_stages(config: NetworkConfiguration, skips: list[int]) -> Iterator[Stage]:
    """Stages from the lowest level to the first; only the first level's transformers ignore amplification."""
    channels, skips = config.level_channels[-1], list(skips)
    for level, width in reversed(list(enumerate(config.level_channels))):
        for number in range(config.num_res_blocks + 1):
            layers: list[nn.Module] = [residual_block(config, channels + skips.pop(), width)]
            if level in config.attention_at_levels:
                layers.append(transformer(config, width, amplified=level > 0))
            if level and number == config.num_res_blocks:
                layers.append(Upsample(width))
            yield Stage(layers)
            channels = width
