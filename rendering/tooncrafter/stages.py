"""Rows of layers, in the order and under the numbers that the UNet and the sketch encoder have in common."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from torch import Tensor, nn

from ..svd.attention import ContextAttention
from ..svd.encoder import Downsample
from ..svd.unet import Upsample
from .configuration import SketchEncoderConfiguration, UNetConfiguration
from .residual_block import ResidualBlock
from .transformer import PromptAndPictureAttention, SpatialTransformer, TemporalTransformer

__all__ = ["Conditions", "Stage", "input_stages", "middle_stage", "output_stages", "skip_channels"]

AnyConfiguration = UNetConfiguration | SketchEncoderConfiguration


@dataclass(frozen=True)
class Conditions:
    """What every layer receives beside its features.

    Attributes:
        embedding: noise level (and frame rate) of each frame, shape [b * t, e].
        context: what the transformers within frames ask: tokens of each clip, shape [b, l, c]; in the UNet followed by
            the picture's tokens of each frame, shape [b * t, k, c].
        frames: t, frames of a clip.
    """

    embedding: Tensor
    context: tuple[Tensor, ...]
    frames: int


class Stage(nn.ModuleList):
    """Layers in a row, each with what it needs of the conditions."""

    def forward(self, x: Tensor, conditions: Conditions) -> Tensor:
        """x: features, shape [b * t, c, h, w]."""
        for layer in self:
            if isinstance(layer, ResidualBlock):
                x = layer(x, conditions.embedding, conditions.frames)
            elif isinstance(layer, SpatialTransformer):
                x = layer(x, *conditions.context)
            elif isinstance(layer, TemporalTransformer):
                clip = x.unflatten(0, (-1, conditions.frames)).transpose(1, 2)
                x = layer(clip).transpose(1, 2).flatten(0, 1)
            else:
                x = layer(x)
        return x


def input_stages(config: AnyConfiguration) -> Iterator[Stage]:
    """From the first convolution down to the lowest level."""
    channels, levels = config.model_channels, config.level_channels
    yield Stage([nn.Conv2d(config.in_channels, channels, 3, padding=1)])
    for level, width in enumerate(levels):
        for _ in range(config.num_res_blocks):
            yield Stage([_residual_block(config, channels, width), *_transformers(config, level, width)])
            channels = width
        if level + 1 < len(levels):
            yield Stage([Downsample(channels)])


def middle_stage(config: AnyConfiguration) -> Stage:
    """The lowest level's middle."""
    width, level = config.level_channels[-1], config.attention_at_levels[-1]
    first, last = (_residual_block(config, width, width) for _ in range(2))
    return Stage([first, *_transformers(config, level, width), last])


def output_stages(config: UNetConfiguration) -> Iterator[Stage]:
    """From the lowest level back up; each stage also receives the output of its input stage."""
    channels, skips = config.level_channels[-1], skip_channels(config)
    for level, width in reversed(list(enumerate(config.level_channels))):
        for number in range(config.num_res_blocks + 1):
            block = _residual_block(config, channels + skips.pop(), width)
            goes_up = level > 0 and number == config.num_res_blocks
            yield Stage([block, *_transformers(config, level, width), *([Upsample(width)] if goes_up else [])])
            channels = width


def skip_channels(config: AnyConfiguration) -> list[int]:
    """Channels of the output of each input stage."""
    levels, blocks = config.level_channels, config.num_res_blocks
    inner = [each for level in levels[:-1] for each in [level] * (blocks + 1)]
    return [levels[0], *inner, *[levels[-1]] * blocks]


def _residual_block(config: AnyConfiguration, channels_in: int, channels_out: int) -> ResidualBlock:
    temporal = isinstance(config, UNetConfiguration)
    return ResidualBlock(channels_in, channels_out, config.embedding_channels, temporal=temporal)


def _transformers(config: AnyConfiguration, level: int, width: int) -> list[nn.Module]:
    if level not in config.attention_at_levels:
        return []
    heads, context = config.num_head_channels, config.context_dim
    if isinstance(config, SketchEncoderConfiguration):
        return [SpatialTransformer(width, heads, ContextAttention(width, heads, context))]
    second = PromptAndPictureAttention(width, heads, context)
    return [SpatialTransformer(width, heads, second), TemporalTransformer.linear(width, heads)]
