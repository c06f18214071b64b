"""Blocks of the autoencoder: within each picture, and over time."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor, nn
from torch.nn import functional

from ..svd.residual_block import normalised
from .clip_features import ClipFeatures, TimeStack

__all__ = ["Level", "Middle", "PictureAttention", "PictureBlock", "VideoBlock"]

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
        return self.within_pictures(x)

    def within_pictures(self, x: Tensor) -> Tensor:
        """x: features, shape [t, c, h, w]."""
        h = self.conv1(functional.silu(self.norm1(x)))
        h = self.conv2(functional.silu(self.norm2(h)))
        return h + (self.nin_shortcut(x) if hasattr(self, "nin_shortcut") else x)


class VideoBlock(PictureBlock):
    """Residual block within each picture, then over time, blended: sigmoid(factor) of the latter."""

    def __init__(self, channels_in: int, channels_out: int) -> None:
        super().__init__(channels_in, channels_out)
        self.time_stack = TimeStack(_over_time(channels_out), _over_time(channels_out, nn.Dropout(0)))
        self.mix_factor = nn.Parameter(torch.zeros(1))

    def forward(self, features: ClipFeatures) -> Tensor:  # type: ignore[override]
        """Change the features of a clip, and return what they are then."""
        features.then(self.within_pictures)
        features.add_over_time(self.time_stack, torch.sigmoid(self.mix_factor))
        return features.settled()


def _over_time(channels: int, *before: nn.Module) -> nn.Sequential:
    convolution = nn.Conv3d(channels, channels, (3, 1, 1), padding=(1, 0, 0))
    return nn.Sequential(normalised(channels), nn.SiLU(), *before, convolution)


def _attention(q: Tensor, k: Tensor, v: Tensor) -> Tensor:
    """Attention of one picture, shapes [l, c]."""
    return functional.scaled_dot_product_attention(q[None], k[None], v[None])[0]


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
        # One by one: devices without fused attention hold every pair of pixels.
        one_by_one = (_attention(*each) for each in zip(q, k, v, strict=True))
        mixed = torch.stack(list(one_by_one))
        return x + self.proj_out(mixed.transpose(1, 2).unflatten(2, x.shape[2:]))


class Level(nn.Module):
    """Blocks of one level and, but for the last, the way to the next."""

    def __init__(
        self, blocks: Sequence[nn.Module], downsample: nn.Module | None = None, upsample: nn.Module | None = None
    ) -> None:
        super().__init__()
        self.block = nn.ModuleList(blocks)
        self.downsample = downsample
        self.upsample = upsample

    def forward(self, x: Tensor) -> Tensor:
        """The blocks alone."""
        for block in self.block:
            x = block(x)
        return x


class Middle(nn.Module):
    """Blocks of the lowest level, around attention."""

    def __init__(self, block: type[PictureBlock], channels: int) -> None:
        super().__init__()
        self.block_1, self.block_2 = block(channels, channels), block(channels, channels)
        self.attn_1 = PictureAttention(channels)

    def forward(self, x: Tensor) -> Tensor:
        """Of blocks within pictures."""
        return self.block_2(self.attn_1(self.block_1(x)))

    def over_clip(self, features: ClipFeatures) -> None:
        """Of video blocks: change the features of a clip."""
        self.block_1(features)
        features.then(self.attn_1)
        self.block_2(features)
