"""The spatio-temporal transformer: attention within frames, then over time, and their blend."""

from __future__ import annotations

import torch
from diffusers.models.attention import FeedForward
from torch import Tensor, nn

from ..networks.embeddings import embedding_layers, sinusoid
from .attention import ContextAttention, MaskedTemporalAttention, ReferenceAttention
from .residual_block import Blend, Conditions, normalised

__all__ = ["SpatioTemporalTransformer"]


class _SpatialBlock(nn.Module):
    """Transformer block on the tokens of each frame."""

    def __init__(self, channels: int, head_channels: int, context_channels: int, *, amplified: bool) -> None:
        super().__init__()
        self.norm1, self.norm2, self.norm3 = (nn.LayerNorm(channels) for _ in range(3))
        self.attn1 = ReferenceAttention(channels, head_channels, amplified=amplified)
        self.attn2 = ContextAttention(channels, head_channels, context_channels)
        self.ff = FeedForward(channels, activation_fn="geglu")

    def forward(self, x: Tensor, conditions: Conditions) -> Tensor:
        """x: tokens, shape [b * t, n, c]."""
        x = x + self.attn1(self.norm1(x), conditions.layout)
        x = x + self.attn2(self.norm2(x), conditions.context)
        return x + self.ff(self.norm3(x))


class _TemporalBlock(nn.Module):
    """Transformer block on the frames of each place."""

    def __init__(self, channels: int, head_channels: int, context_channels: int) -> None:
        super().__init__()
        self.norm_in, self.norm1, self.norm2, self.norm3 = (nn.LayerNorm(channels) for _ in range(4))
        self.ff_in, self.ff = (FeedForward(channels, activation_fn="geglu") for _ in range(2))
        self.attn1 = MaskedTemporalAttention(channels, head_channels)
        self.attn2 = ContextAttention(channels, head_channels, context_channels)

    def forward(self, x: Tensor, conditions: Conditions) -> Tensor:
        """x: tokens, shape [b * n, t, c]."""
        x = x + self.ff_in(self.norm_in(x))
        x = x + self.attn1(self.norm1(x), conditions.layout.references)
        x = x + self.attn2(self.norm2(x), conditions.context)
        return x + self.ff(self.norm3(x))


class SpatioTemporalTransformer(nn.Module):
    """Transformer of the video networks, around a residual connection."""

    def __init__(self, channels: int, head_channels: int, context_channels: int, *, amplified: bool) -> None:
        super().__init__()
        self.norm = normalised(channels, epsilon=1e-6)
        self.proj_in = nn.Linear(channels, channels)
        spatial = _SpatialBlock(channels, head_channels, context_channels, amplified=amplified)
        self.transformer_blocks = nn.ModuleList([spatial])
        self.time_pos_embed = embedding_layers(channels, 4 * channels, channels)
        self.time_stack = nn.ModuleList([_TemporalBlock(channels, head_channels, context_channels)])
        self.time_mixer = Blend()
        self.proj_out = nn.Linear(channels, channels)

    def forward(self, x: Tensor, conditions: Conditions) -> Tensor:
        """x: features, shape [b * t, c, h, w]."""
        tokens = self.proj_in(self.norm(x).flatten(2).transpose(1, 2))
        spatial = self.transformer_blocks[0](tokens, conditions)
        tokens = self.proj_out(self.time_mixer(spatial, self._over_time(spatial, conditions)))
        return x + tokens.transpose(1, 2).unflatten(2, x.shape[2:])

    def _over_time(self, x: Tensor, conditions: Conditions) -> Tensor:
        """The temporal block's view of tokens of shape [b * t, n, c]; each frame is told its time."""
        times = torch.tensor(conditions.layout.times, device=x.device).repeat(len(conditions.context))
        x = x + self.time_pos_embed(sinusoid(times, x.shape[-1]).to(x.dtype))[:, None]
        x = x.unflatten(0, (-1, conditions.layout.count)).transpose(1, 2)
        batch = x.shape[:2]
        x = self.time_stack[0](x.flatten(0, 1), conditions)
        return x.unflatten(0, batch).transpose(1, 2).flatten(0, 1)
