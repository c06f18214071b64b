"""How the decoder takes details from both keyframes, which latents are too coarse to hold."""

from __future__ import annotations

from torch import Tensor, nn
from torch.nn import functional

from ..svd.residual_block import normalised
from .clip_features import ClipFeatures
from .configuration import AutoencoderConfiguration

__all__ = ["AddReferences", "AttendToReferences"]


class AddReferences(nn.Module):
    """Adds the keyframes' features to the first and the last frame."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.conv = nn.Conv2d(channels, channels, 1)

    def forward(self, features: ClipFeatures, references: Tensor) -> Tensor:
        """Change the features of a clip, and return what they are then.

        Args:
            features: of the clip.
            references: of both keyframes, shape [1, c, 2, h, w].
        """
        first, last = self.conv(references[0].transpose(0, 1))
        x = features.settled()
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

    def keys_and_values(self, references: Tensor) -> tuple[Tensor, Tensor]:
        """references: of both keyframes, shape [1, c, 2, h, w]; what all frames find there."""
        pixels = references.flatten(2).transpose(1, 2)
        return self._in_heads(self.to_k(pixels)), self._in_heads(self.to_v(pixels))

    def forward(self, x: Tensor, keys: Tensor, values: Tensor) -> Tensor:
        """x: features of pictures, shape [n, c, h, w]; keys and values: shape [1, heads, places, channels]."""
        q = self._in_heads(self.to_q(self.norm(x).flatten(2).transpose(1, 2)))
        k, v = (each.expand(len(x), -1, -1, -1) for each in (keys, values))
        mixed = self.to_out(functional.scaled_dot_product_attention(q, k, v).transpose(1, 2).flatten(2))
        return x + mixed.transpose(1, 2).unflatten(2, x.shape[2:])

    def _in_heads(self, x: Tensor) -> Tensor:
        return x.unflatten(-1, (-1, self.head_channels)).transpose(1, 2)
