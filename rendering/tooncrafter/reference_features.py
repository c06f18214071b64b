"""How the decoder takes details from both keyframes, which latents are too coarse to hold."""

from __future__ import annotations

from torch import Tensor, nn
from torch.nn import functional

from ..svd.residual_block import normalised
from .configuration import AutoencoderConfiguration

__all__ = ["AddReferences", "AttendToReferences"]


class AddReferences(nn.Module):
    """Adds the keyframes' features to the first and the last frame."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.conv = nn.Conv2d(channels, channels, 1)

    def forward(self, x: Tensor, references: Tensor) -> Tensor:
        """x: features of one clip, shape [t, c, h, w]; references: of both keyframes, shape [1, c, 2, h, w]."""
        first, last = self.conv(references[0].transpose(0, 1))
        x = x.clone()
        x[0] += first
        x[-1] += last
        return x


class AttendToReferences(nn.Module):
    """All frames attend to the pixels of both keyframes' features, around a residual connection."""

    def __init__(self, channels: int, config: AutoencoderConfiguration) -> None:
        super().__init__()
        self.head_channels, inner = config.fusion_dim_head, config.fusion_heads * config.fusion_dim_head
        self.norm = normalised(channels, epsilon=1e-6)
        self.to_q, self.to_k, self.to_v = (nn.Linear(channels, inner, bias=False) for _ in range(3))
        self.to_out = nn.Sequential(nn.Linear(inner, channels))

    def forward(self, x: Tensor, references: Tensor) -> Tensor:
        """x: features of one clip, shape [t, c, h, w]; references: of both keyframes, shape [1, c, 2, h, w]."""
        queries = self.to_q(self.norm(x).flatten(2).transpose(1, 2))
        pixels = references.flatten(2).transpose(1, 2)
        q, k, v = (
            each.unflatten(-1, (-1, self.head_channels)).transpose(1, 2).expand(len(x), -1, -1, -1)
            for each in (queries, self.to_k(pixels), self.to_v(pixels))
        )
        mixed = self.to_out(functional.scaled_dot_product_attention(q, k, v).transpose(1, 2).flatten(2))
        return x + mixed.transpose(1, 2).unflatten(2, x.shape[2:])
