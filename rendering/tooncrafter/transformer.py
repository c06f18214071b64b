"""The UNet's transformers: within each frame, with prompt and picture as context; and over time."""

from __future__ import annotations

from collections.abc import Callable

from diffusers.models.attention import FeedForward
from torch import Tensor, nn

from ..svd.attention import ContextAttention
from ..svd.residual_block import normalised

__all__ = ["PromptAndPictureAttention", "SpatialTransformer", "TemporalTransformer", "TransformerBlock"]


class PromptAndPictureAttention(ContextAttention):
    """The same queries ask the prompt, and separately the picture's tokens of their frame; both answers are added."""

    def __init__(self, channels: int, head_channels: int, context_channels: int) -> None:
        super().__init__(channels, head_channels, context_channels)
        self.to_k_ip = nn.Linear(context_channels, channels, bias=False)
        self.to_v_ip = nn.Linear(context_channels, channels, bias=False)

    def forward(self, x: Tensor, prompt: Tensor, pictures: Tensor) -> Tensor:  # type: ignore[override]
        """Attend.

        Args:
            x: tokens of each frame, shape [b * t, n, c].
            prompt: shape [b, l, context channels].
            pictures: tokens for each frame, shape [b * t, k, context channels].
        """
        queries = self.to_q(x)
        of_clip = queries.reshape(len(prompt), -1, x.shape[-1])
        told = self._attend(of_clip, self.to_k(prompt), self.to_v(prompt)).reshape(x.shape)
        return self.to_out(told + self._attend(queries, self.to_k_ip(pictures), self.to_v_ip(pictures)))


class TransformerBlock(nn.Module):
    """Self-attention, a second attention, and two gated layers, each added to its input."""

    def __init__(self, channels: int, head_channels: int, second: ContextAttention) -> None:
        super().__init__()
        self.norm1, self.norm2, self.norm3 = (nn.LayerNorm(channels) for _ in range(3))
        self.attn1 = ContextAttention(channels, head_channels)
        self.attn2 = second
        self.ff = FeedForward(channels, activation_fn="geglu")

    def forward(self, x: Tensor, *context: Tensor) -> Tensor:
        """Apply.

        Args:
            x: tokens, shape [n, tokens, c].
            context: what the second attention asks; x itself without any.
        """
        normal = self.norm1(x)
        x = x + self.attn1(normal, normal)
        normal = self.norm2(x)
        x = x + self.attn2(normal, *(context or (normal,)))
        return x + self.ff(self.norm3(x))


class SpatialTransformer(nn.Module):
    """Transformer on the pixels of each frame, around a residual connection."""

    def __init__(self, channels: int, head_channels: int, second: ContextAttention) -> None:
        super().__init__()
        self.norm = normalised(channels, epsilon=1e-6)
        self.proj_in = nn.Linear(channels, channels)
        self.transformer_blocks = nn.ModuleList([TransformerBlock(channels, head_channels, second)])
        self.proj_out = nn.Linear(channels, channels)

    def forward(self, x: Tensor, *context: Tensor) -> Tensor:
        """x: features, shape [b * t, c, h, w]; context: as its second attention takes it."""
        tokens = self.proj_in(self.norm(x).flatten(2).transpose(1, 2))
        tokens = self.proj_out(self.transformer_blocks[0](tokens, *context))
        return x + tokens.transpose(1, 2).unflatten(2, x.shape[2:])


class TemporalTransformer(nn.Module):
    """Transformer on the frames of each pixel, around a residual connection; both attentions are over time."""

    def __init__(self, channels: int, head_channels: int, inner: int, project: Callable[[int, int], nn.Module]) -> None:
        """Prepare the layer.

        Args:
            channels: of the features.
            head_channels: of an attention head.
            inner: channels inside.
            project: makes the projections between both.
        """
        super().__init__()
        self.norm = normalised(channels, epsilon=1e-6)
        self.proj_in = project(channels, inner)
        block = TransformerBlock(inner, head_channels, ContextAttention(inner, head_channels))
        self.transformer_blocks = nn.ModuleList([block])
        self.proj_out = project(inner, channels)

    @classmethod
    def linear(cls, channels: int, head_channels: int) -> TemporalTransformer:
        """As it follows the transformers within frames."""
        return cls(channels, head_channels, channels, nn.Linear)

    @classmethod
    def convolutional(cls, channels: int, head_channels: int, heads: int) -> TemporalTransformer:
        """As it follows the first convolution: projections are convolutions one frame wide."""
        return cls(channels, head_channels, heads * head_channels, lambda a, b: FrameProjection(a, b, 1))

    def forward(self, x: Tensor) -> Tensor:
        """x: features, shape [b, c, t, h, w]."""
        b, _, t, h, w = x.shape
        tokens = self.norm(x).permute(0, 3, 4, 2, 1).reshape(b * h * w, t, -1)
        tokens = self.proj_out(self.transformer_blocks[0](self.proj_in(tokens)))
        return x + tokens.reshape(b, h, w, t, -1).permute(0, 4, 3, 1, 2)


class FrameProjection(nn.Conv1d):
    """A convolution over frames that takes and gives channels last, shape [n, t, c]."""

    def forward(self, x: Tensor) -> Tensor:
        return super().forward(x.transpose(1, 2)).transpose(1, 2)
