"""Sizes of the video networks; the defaults are those of the public Stable Video Diffusion (14 frames) and LVCD."""

from __future__ import annotations

from dataclasses import dataclass

from ...physics.errors import require
from ..networks import FromValues

__all__ = ["NetworkConfiguration"]


@dataclass(frozen=True)
class NetworkConfiguration(FromValues):
    """What the weights' shapes follow from.

    Attributes:
        in_channels: of the noisy latent and the condition latent together.
        out_channels: of the prediction.
        hint_channels: of the sketch.
        model_channels: width m of the first level.
        channel_mult: width of each level, in multiples of m.
        num_res_blocks: residual blocks a level.
        attention_at_levels: levels whose residual blocks are followed by transformers.
        num_head_channels: channels of one attention head.
        context_dim: channels of the picture embedding.
        adm_in_channels: channels of the embedded micro-conditioning (three numbers).
        ids_embed_dim: channels of one embedded number of it.
        video_kernel_size: of the temporal convolutions: frames, rows, columns.
    """

    in_channels: int = 8
    out_channels: int = 4
    hint_channels: int = 3
    model_channels: int = 320
    channel_mult: tuple[int, ...] = (1, 2, 4, 4)
    num_res_blocks: int = 2
    attention_at_levels: tuple[int, ...] = (0, 1, 2)
    num_head_channels: int = 64
    context_dim: int = 1024
    adm_in_channels: int = 768
    ids_embed_dim: int = 256
    video_kernel_size: tuple[int, int, int] = (3, 1, 1)

    def __post_init__(self) -> None:
        frames, *window = self.video_kernel_size
        temporal = frames % 2 == 1 and window == [1, 1]
        require("video_kernel_size", self.video_kernel_size, temporal, "an odd number of frames, 1 and 1")
        width, heads = self.model_channels, self.num_head_channels
        require("model_channels", width, width % 32 == 0 and width % heads == 0, f"a multiple of 32 and of {heads}")

    @property
    def embedding_channels(self) -> int:
        """Channels of the embedding that every residual block receives."""
        return 4 * self.model_channels

    @property
    def level_channels(self) -> tuple[int, ...]:
        """Channels of each level."""
        return tuple(self.model_channels * multiple for multiple in self.channel_mult)
