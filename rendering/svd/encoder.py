"""The encoder half and the middle, which the UNet and its sketch ControlNet have in common."""

from __future__ import annotations

from collections.abc import Iterator

from torch import Tensor, nn

from ..networks.embeddings import embedding_layers, sinusoid
from .configuration import NetworkConfiguration
from .frame_layout import FrameLayout
from .residual_block import Conditions, VideoResidualBlock
from .transformer import SpatioTemporalTransformer

__all__ = ["Downsample", "SpatioTemporalEncoder", "Stage", "residual_block", "transformer"]


class Stage(nn.ModuleList):
    """Layers in a row; those that need the conditions get them."""

    def forward(self, x: Tensor, conditions: Conditions) -> Tensor:
        """x: features, shape [b * t, c, h, w]."""
        for layer in self:
            conditional = isinstance(layer, (VideoResidualBlock, SpatioTemporalTransformer))
            x = layer(x, conditions) if conditional else layer(x)
        return x


class Downsample(nn.Module):
    """Half the height and width, by a strided convolution."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.op = nn.Conv2d(channels, channels, 3, stride=2, padding=1)

    def forward(self, x: Tensor) -> Tensor:
        return self.op(x)


def residual_block(config: NetworkConfiguration, channels_in: int, channels_out: int) -> VideoResidualBlock:
    """A residual block of the configured kind."""
    return VideoResidualBlock(channels_in, channels_out, config.embedding_channels, config.video_kernel_size)


def transformer(config: NetworkConfiguration, channels: int, *, amplified: bool = True) -> SpatioTemporalTransformer:
    """A transformer of the configured kind."""
    return SpatioTemporalTransformer(channels, config.num_head_channels, config.context_dim, amplified=amplified)


class SpatioTemporalEncoder(nn.Module):
    """Embeddings, input blocks and middle block."""

    def __init__(self, config: NetworkConfiguration) -> None:
        super().__init__()
        self.config = config
        width, embedding = config.model_channels, config.embedding_channels
        self.time_embed = embedding_layers(width, embedding, embedding)
        self.label_emb = nn.Sequential(embedding_layers(config.adm_in_channels, embedding, embedding))
        self.input_blocks = nn.ModuleList(_input_stages(config))
        last = config.level_channels[-1]
        self.middle_block = Stage(
            [residual_block(config, last, last), transformer(config, last), residual_block(config, last, last)]
        )

    @property
    def skip_channels(self) -> list[int]:
        """Channels of the output of each input block."""
        levels, blocks = self.config.level_channels, self.config.num_res_blocks
        inner = [each for level in levels[:-1] for each in [level] * (blocks + 1)]
        return [levels[0], *inner, *[levels[-1]] * blocks]

    def conditions(self, noise_level: Tensor, context: Tensor, ids: Tensor, layout: FrameLayout) -> Conditions:
        """What every block receives.

        Args:
            noise_level: ln(sigma) / 4 of each video, shape [b].
            context: embedding of each video's picture, shape [b, l, c].
            ids: frames per second, motion bucket and noise of the picture, shape [b, 3].
            layout: the segment's frames.
        """
        dtype = context.dtype
        numbers = sinusoid(ids.flatten(), self.config.ids_embed_dim).reshape(len(ids), -1)
        embedding = self.time_embed(sinusoid(noise_level, self.config.model_channels).to(dtype))
        embedding = embedding + self.label_emb(numbers.to(dtype))
        return Conditions(embedding.repeat_interleave(layout.count, dim=0), context, layout)

    def encode(self, x: Tensor, conditions: Conditions, hint: Tensor | None = None) -> tuple[list[Tensor], Tensor]:
        """Outputs of all input blocks, and of the middle.

        Args:
            x: noisy and condition latents, shape [b * t, c, h, w].
            conditions: what every block receives.
            hint: added to the output of the first block, shape [b * t, m, h, w].
        """
        skips: list[Tensor] = []
        for number, stage in enumerate(self.input_blocks):
            x = stage(x, conditions)
            if hint is not None and number == 0:
                x = x + hint
            skips.append(x)
        return skips, self.middle_block(x, conditions)


def _input_stages(config: NetworkConfiguration) -> Iterator[Stage]:
    channels, levels = config.model_channels, config.level_channels
    yield Stage([nn.Conv2d(config.in_channels, channels, 3, padding=1)])
    for level, width in enumerate(levels):
        for _ in range(config.num_res_blocks):
            attention = [transformer(config, width)] if level in config.attention_at_levels else []
            yield Stage([residual_block(config, channels, width), *attention])
            channels = width
        if level + 1 < len(levels):
            yield Stage([Downsample(channels)])
