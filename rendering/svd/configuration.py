"""Sizes of the video networks; the defaults are those of the public Stable Video Diffusion (14 frames) and LVCD."""

from __future__ import annotations

from dataclasses import dataclass

from ...physics.errors import require
from ..networks import DiffusionConfiguration

__all__ = ["NetworkConfiguration"]


@dataclass(frozen=True)
class NetworkConfiguration(DiffusionConfiguration):
    """What the weights' shapes follow from: the sizes in common and these.

    Attributes:
        in_channels: of the noisy latent and the condition latent together.
        out_channels: of the prediction.
        hint_channels: of the sketch.
        adm_in_channels: channels of the embedded micro-conditioning (three numbers).
        ids_embed_dim: channels of one embedded number of it.
        video_kernel_size: of the temporal convolutions: frames, rows, columns.
    """

    in_channels: int = 8
    out_channels: int = 4
    hint_channels: int = 3
    adm_in_channels: int = 768
    ids_embed_dim: int = 256
    video_kernel_size: tuple[int, int, int] = (3, 1, 1)

    def __post_init__(self) -> None:
        frames, *window = self.video_kernel_size
        temporal = frames % 2 == 1 and window == [1, 1]
        require("video_kernel_size", self.video_kernel_size, temporal, "an odd number of frames, 1 and 1")
        super().__post_init__()
