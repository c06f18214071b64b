"""From the picture encoder's tokens to a few tokens for each frame (ToonCrafter, after Flamingo's resampler)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import torch
from torch import Tensor, nn
from torch.nn import functional

from ..networks.checkpoints import network_of
from .configuration import ResamplerConfiguration

__all__ = ["ImageResampler"]


class _Attention(nn.Module):
    """The learned queries attend to the picture's tokens and to themselves."""

    def __init__(self, config: ResamplerConfiguration) -> None:
        super().__init__()
        self.head_channels, inner = config.dim_head, config.heads * config.dim_head
        self.norm1, self.norm2 = nn.LayerNorm(config.dim), nn.LayerNorm(config.dim)
        self.to_q = nn.Linear(config.dim, inner, bias=False)
        self.to_kv = nn.Linear(config.dim, 2 * inner, bias=False)
        self.to_out = nn.Linear(inner, config.dim, bias=False)

    def forward(self, tokens: Tensor, queries: Tensor) -> Tensor:
        """tokens: shape [b, n, c]; queries: shape [b, m, c]; gives what is to be added to the queries."""
        tokens, queries = self.norm1(tokens), self.norm2(queries)
        keys, values = self.to_kv(torch.cat([tokens, queries], dim=1)).chunk(2, dim=-1)
        q, k, v = (
            each.unflatten(-1, (-1, self.head_channels)).transpose(1, 2) for each in (self.to_q(queries), keys, values)
        )
        return self.to_out(functional.scaled_dot_product_attention(q, k, v).transpose(1, 2).flatten(2))


def _feed_forward(config: ResamplerConfiguration) -> nn.Sequential:
    inner = config.ff_mult * config.dim
    first, second = nn.Linear(config.dim, inner, bias=False), nn.Linear(inner, config.dim, bias=False)
    return nn.Sequential(nn.LayerNorm(config.dim), first, nn.GELU(), second)


class _Layer(nn.ModuleList):
    def __init__(self, config: ResamplerConfiguration) -> None:
        super().__init__([_Attention(config), _feed_forward(config)])

    def forward(self, tokens: Tensor, queries: Tensor) -> Tensor:
        queries = queries + self[0](tokens, queries)
        return queries + self[1](queries)


class ImageResampler(nn.Module):
    """Learned queries for each frame that gather what is in a picture, for the UNet's cross-attention."""

    prefix = "image_proj_model."
    """Before its names in the public checkpoint."""

    def __init__(self, config: ResamplerConfiguration) -> None:
        super().__init__()
        self.config = config
        self.latents = nn.Parameter(torch.zeros(1, config.num_queries * config.video_length, config.dim))
        self.proj_in = nn.Linear(config.embedding_dim, config.dim)
        self.layers = nn.ModuleList(_Layer(config) for _ in range(config.depth))
        self.proj_out = nn.Linear(config.dim, config.output_dim)
        self.norm_out = nn.LayerNorm(config.output_dim)

    @classmethod
    def from_reference(
        cls, config: ResamplerConfiguration | Mapping[str, Any], state_dict: Mapping[str, Any]
    ) -> ImageResampler:
        """A network with the weights of a state dict, whose names are the public checkpoint's, prefix included."""
        return network_of(
            lambda: cls(ResamplerConfiguration.of(config)),
            state_dict,
            wanted="weights of ToonCrafter's resampler",
            prefix=cls.prefix,
        )

    def forward(self, tokens: Tensor) -> Tensor:
        """Resample.

        Args:
            tokens: of the picture encoder, shape [b, n, embedding_dim].

        Returns:
            Tokens for each frame, one frame's after another's, shape [b, num_queries * video_length, output_dim].
        """
        tokens = self.proj_in(tokens)
        queries = self.latents.expand(len(tokens), -1, -1)
        for layer in self.layers:
            queries = layer(tokens, queries)
        return self.norm_out(self.proj_out(queries))
