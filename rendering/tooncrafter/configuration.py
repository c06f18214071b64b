"""Sizes of the interpolation networks; the defaults are those of the public ToonCrafter."""

from __future__ import annotations

from dataclasses import dataclass

from ...physics.errors import require
from ..networks import DiffusionConfiguration, FromValues

__all__ = [
    "AutoencoderConfiguration",
    "ResamplerConfiguration",
    "SketchEncoderConfiguration",
    "UNetConfiguration",
]


@dataclass(frozen=True)
class UNetConfiguration(DiffusionConfiguration):
    """What the shapes of the UNet's weights follow from: the sizes in common and these.

    Attributes:
        in_channels: of the noisy latent and the condition latent together.
        out_channels: of the prediction.
        temporal_length: frames of a clip, both keyframes included.
        init_attn_heads: heads of the first transformer over time.
        text_tokens: tokens of the prompt, at the head of the context.
        image_tokens_per_frame: tokens of the picture for each frame, behind them.
        default_fs: frame rate where none is told [1/s].
    """

    in_channels: int = 8
    out_channels: int = 4
    temporal_length: int = 16
    init_attn_heads: int = 8
    text_tokens: int = 77
    image_tokens_per_frame: int = 16
    default_fs: int = 24


@dataclass(frozen=True)
class SketchEncoderConfiguration(DiffusionConfiguration):
    """What the shapes of the sketch encoder's weights follow from: the sizes in common and these.

    Attributes:
        in_channels: of the noisy latent.
        hint_channels: of the sketch.
    """

    in_channels: int = 4
    hint_channels: int = 1


@dataclass(frozen=True)
class ResamplerConfiguration(FromValues):
    """What the shapes of the resampler's weights follow from.

    Attributes:
        dim: channels inside.
        depth: number of layers.
        heads: of attention.
        dim_head: channels of a head.
        num_queries: tokens for each frame.
        embedding_dim: channels of the picture encoder's tokens.
        output_dim: channels of the context.
        ff_mult: width inside the feed-forward layers, in multiples of ``dim``.
        video_length: frames of a clip.
    """

    dim: int = 1024
    depth: int = 4
    heads: int = 12
    dim_head: int = 64
    num_queries: int = 16
    embedding_dim: int = 1280
    output_dim: int = 1024
    ff_mult: int = 4
    video_length: int = 16


@dataclass(frozen=True)
class AutoencoderConfiguration(FromValues):
    """What the shapes of the autoencoder's weights follow from.

    Attributes:
        ch: width of the first level.
        ch_mult: width of each level, in multiples of it.
        num_res_blocks: residual blocks a level; the decoder has one more.
        z_channels: of a latent.
        embed_dim: of a latent.
        double_z: whether the encoder gives means and variances.
        attn_resolutions: none; attention is in the middle only.
        fusion_heads: heads of the decoder's attention to the keyframes.
        fusion_dim_head: channels of such a head.
        fusion_levels: levels that attend to the keyframes; the others add their features.
    """

    ch: int = 128
    ch_mult: tuple[int, ...] = (1, 2, 4, 4)
    num_res_blocks: int = 2
    z_channels: int = 4
    embed_dim: int = 4
    double_z: bool = True
    attn_resolutions: tuple[int, ...] = ()
    fusion_heads: int = 8
    fusion_dim_head: int = 64
    fusion_levels: tuple[int, ...] = (2, 3)

    def __post_init__(self) -> None:
        require("double_z", self.double_z, self.double_z, "true")
        require("attn_resolutions", self.attn_resolutions, not self.attn_resolutions, "empty")

    @property
    def level_channels(self) -> tuple[int, ...]:
        """Channels of each level."""
        return tuple(self.ch * multiple for multiple in self.ch_mult)
