"""Blocks of the autoencoder: within each picture, and over time."""

from __future__ import annotations

import torch
from torch import Tensor, nn
from torch.nn import functional

from ..svd.residual_block import normalised

__all__ = ["PictureAttention", "PictureBlock", "VideoBlock"]

_EPSILON = 1e-6


class PictureBlock(nn.Module):
    """Residual block within each picture."""

    def __init__(self, channels_in: int, channels_out: int) -> None:
        super().__init__()
        self.norm1, self.norm2 = (normalised(each, epsilon=_EPSILON) for each in (channels_in, channels_out))
        self.conv1 = nn.Conv2d(channels_in, channels_out, 3, padding=1)
        self.conv2 = nn.Conv2d(channels_out, channels_out, 3, padding=1)
        if channels_in != channels_out:
            self.nin_shortcut = nn.Conv2d(channels_in, channels_out, 1)

    def forward(self, x: Tensor) -> Tensor:
        """x: features, shape [t, c, h, w]."""
        h = self.conv1(functional.silu(self.norm1(x)))
        h = self.conv2(functional.silu(self.norm2(h)))
        return h + (self.nin_shortcut(x) if hasattr(self, "nin_shortcut") else x)


class _TimeStack(nn.Module):
    """What time adds to the features of a clip."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        first, second = (nn.Conv3d(channels, channels, (3, 1, 1), padding=(1, 0, 0)) for _ in range(2))
        self.in_layers = nn.Sequential(normalised(channels), nn.SiLU(), first)
        self.out_layers = nn.Sequential(normalised(channels), nn.SiLU(), nn.Dropout(0), second)

    def forward(self, x: Tensor) -> Tensor:
        """x: features, shape [1, c, t, h, w]."""
        return self.out_layers(self.in_layers(x))


class VideoBlock(PictureBlock):
    """Residual block within each picture, then over time, blended: sigmoid(factor) of the latter."""

    def __init__(self, channels_in: int, channels_out: int) -> None:
        super().__init__(channels_in, channels_out)
        self.time_stack = _TimeStack(channels_out)
        self.mix_factor = nn.Parameter(torch.zeros(1))

    def forward(self, x: Tensor) -> Tensor:
        """x: features of one clip, shape [t, c, h, w]."""
        spatial = super().forward(x)
        added = self.time_stack(spatial.transpose(0, 1)[None])[0].transpose(0, 1)
        return spatial + torch.sigmoid(self.mix_factor) * added


class PictureAttention(nn.Module):
    """Attention of one head among the pixels of each picture, around a residual connection."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.norm = normalised(channels, epsilon=_EPSILON)
        self.q, self.k, self.v, self.proj_out = (nn.Conv2d(channels, channels, 1) for _ in range(4))

    def forward(self, x: Tensor) -> Tensor:
        """x: features, shape [t, c, h, w]."""
        normal = self.norm(x)
        q, k, v = (each(normal).flatten(2).transpose(1, 2) for each in (self.q, self.k, self.v))
        mixed = functional.scaled_dot_product_attention(q, k, v)
        return x + self.proj_out(mixed.transpose(1, 2).unflatten(2, x.shape[2:]))
