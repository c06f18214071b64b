"""The video residual block: one over space, one over time on top of it, and their blend."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn
from torch.nn import functional

from .frame_layout import FrameLayout
from .temporal_convolution import MaskedTemporalConvolution

__all__ = ["Blend", "Conditions", "SpatialResidualBlock", "VideoResidualBlock", "normalised"]


@dataclass(frozen=True)
class Conditions:
    """What every block receives beside its features.

    Attributes:
        embedding: noise level and micro-conditioning of each frame, shape [b * t, e].
        context: embedding of the picture, shape [b, l, c].
        layout: the segment's frames.
    """

    embedding: Tensor
    context: Tensor
    layout: FrameLayout


def normalised(channels: int, *, epsilon: float = 1e-5) -> nn.GroupNorm:
    """Normalisation in 32 groups; residual blocks and transformers differ in epsilon."""
    return nn.GroupNorm(32, channels, eps=epsilon)


class Blend(nn.Module):
    """A learned mean of what space and time give: sigmoid(factor) of the former."""

    def __init__(self) -> None:
        super().__init__()
        self.mix_factor = nn.Parameter(torch.zeros(1))

    def forward(self, spatial: Tensor, temporal: Tensor) -> Tensor:
        share = torch.sigmoid(self.mix_factor)
        return share * spatial + (1 - share) * temporal


class _TemporalResidual(nn.Module):
    """What time adds to the features of a clip."""

    def __init__(self, channels: int, embedding_channels: int, kernel: tuple[int, int, int]) -> None:
        super().__init__()
        first, second = (MaskedTemporalConvolution(channels, channels, kernel) for _ in range(2))
        self.in_layers = nn.ModuleList([normalised(channels), nn.SiLU(), first])
        self.emb_layers = nn.Sequential(nn.SiLU(), nn.Linear(embedding_channels, channels))
        self.out_layers = nn.ModuleList([normalised(channels), nn.SiLU(), nn.Dropout(0), second])

    def forward(self, x: Tensor, conditions: Conditions) -> Tensor:
        """x: features, shape [b, c, t, h, w]."""
        references = conditions.layout.references
        h = self.in_layers[2](functional.silu(self.in_layers[0](x)), references)
        embedding = self.emb_layers(conditions.embedding).unflatten(0, (len(x), -1))
        h = h + embedding.transpose(1, 2)[..., None, None]
        return self.out_layers[3](functional.silu(self.out_layers[0](h)), references)


class SpatialResidualBlock(nn.Module):
    """What the residual blocks of both video models do to each frame by itself."""

    def __init__(self, channels_in: int, channels_out: int, embedding_channels: int) -> None:
        super().__init__()
        first, second = (nn.Conv2d(each, channels_out, 3, padding=1) for each in (channels_in, channels_out))
        self.in_layers = nn.Sequential(normalised(channels_in), nn.SiLU(), first)
        self.emb_layers = nn.Sequential(nn.SiLU(), nn.Linear(embedding_channels, channels_out))
        self.out_layers = nn.Sequential(normalised(channels_out), nn.SiLU(), nn.Dropout(0), second)
        changes = channels_in != channels_out
        self.skip_connection = nn.Conv2d(channels_in, channels_out, 1) if changes else nn.Identity()

    def spatial(self, x: Tensor, embedding: Tensor) -> Tensor:
        """x: features, shape [b * t, c, h, w]; embedding: of each frame, shape [b * t, e]."""
        h = self.in_layers(x) + self.emb_layers(embedding)[..., None, None]
        return self.skip_connection(x) + self.out_layers(h)


class VideoResidualBlock(SpatialResidualBlock):
    """Residual block of the video networks."""

    def __init__(
        self, channels_in: int, channels_out: int, embedding_channels: int, kernel: tuple[int, int, int]
    ) -> None:
        super().__init__(channels_in, channels_out, embedding_channels)
        self.time_stack = _TemporalResidual(channels_out, embedding_channels, kernel)
        self.time_mixer = Blend()

    def forward(self, x: Tensor, conditions: Conditions) -> Tensor:
        """x: features, shape [b * t, c, h, w]."""
        spatial = self.spatial(x, conditions.embedding)
        clip = spatial.unflatten(0, (-1, conditions.layout.count)).transpose(1, 2)
        added = self.time_stack(clip, conditions).transpose(1, 2).flatten(0, 1)
        return self.time_mixer(spatial, spatial + added)
