"""The three kinds of attention: to a context, to reference frames, and over time (LVCD, Sections 3.2 and 3.4)."""

from __future__ import annotations

import torch
from torch import Tensor, nn
from torch.nn import functional

from .frame_layout import FrameLayout, KeyFrames

__all__ = ["ContextAttention", "MaskedTemporalAttention", "ReferenceAttention"]


class _Attention(nn.Module):
    """Projections to queries, keys and values, and back."""

    def __init__(self, channels: int, head_channels: int, context_channels: int | None = None) -> None:
        super().__init__()
        self.head_channels = head_channels
        self.to_q = nn.Linear(channels, channels, bias=False)
        self.to_k = nn.Linear(context_channels or channels, channels, bias=False)
        self.to_v = nn.Linear(context_channels or channels, channels, bias=False)
        self.to_out = nn.Sequential(nn.Linear(channels, channels))

    def _attend(self, queries: Tensor, keys: Tensor, values: Tensor, bias: Tensor | None = None) -> Tensor:
        """softmax(q k^T / sqrt(head channels) + bias) v in every head; all of shape [n, tokens, channels]."""
        q, k, v = (each.unflatten(-1, (-1, self.head_channels)).transpose(1, 2) for each in (queries, keys, values))
        mixed = functional.scaled_dot_product_attention(q, k, v, attn_mask=bias)
        return mixed.transpose(1, 2).flatten(2)


class ContextAttention(_Attention):
    """Attention to the context of the video, which all its frames share."""

    def forward(self, x: Tensor, context: Tensor) -> Tensor:
        """Attend.

        Args:
            x: tokens, those of one video after those of another, shape [b * n, tokens, c].
            context: shape [b, l, context channels].
        """
        queries = self.to_q(x).reshape(len(context), -1, x.shape[-1])
        mixed = self._attend(queries, self.to_k(context), self.to_v(context))
        return self.to_out(mixed.reshape(x.shape))


class ReferenceAttention(_Attention):
    """Attention in space, to the tokens of two frames at once: mostly the frame itself and a reference frame."""

    def __init__(self, channels: int, head_channels: int, *, amplified: bool) -> None:
        """Prepare the layer.

        Args:
            channels: of a token.
            head_channels: of one head.
            amplified: whether the layer heeds the layout's bias; the last layers of the UNet do not.
        """
        super().__init__(channels, head_channels)
        self.amplified = amplified

    def forward(self, x: Tensor, layout: FrameLayout) -> Tensor:
        """Attend.

        Args:
            x: tokens of each frame, shape [b * t, n, c].
            layout: whose keys each frame uses.
        """
        queries, keys, values = (
            project(x).unflatten(0, (-1, layout.count)) for project in (self.to_q, self.to_k, self.to_v)
        )
        parts, start = [], 0
        for run in layout.runs:
            stop = start + len(run.own)
            bias = _half_bias(run.bias, x) if run.bias and self.amplified else None
            asked = queries[:, start:stop].flatten(0, 1)
            mixed = self._attend(asked, _of_frames(keys, run), _of_frames(values, run), bias)
            parts.append(mixed.unflatten(0, (-1, len(run.own))))
            start = stop
        return self.to_out(torch.cat(parts, dim=1).flatten(0, 1))


class MaskedTemporalAttention(_Attention):
    """Attention over time: clip frames see the clip, a reference frame sees itself only."""

    def forward(self, x: Tensor, references: int) -> Tensor:
        """Attend.

        Args:
            x: one sequence of frames a place, shape [n, t, c].
            references: number of leading frames that see themselves only.
        """
        values, clip = self.to_v(x), x[:, references:]
        mixed = self._attend(self.to_q(clip), self.to_k(clip), values[:, references:])
        return self.to_out(torch.cat([values[:, :references], mixed], dim=1))


def _of_frames(x: Tensor, run: KeyFrames) -> Tensor:
    """Tokens, shape [b, t, n, c], of the frames that each frame of the run attends to, shape [b * run, n or 2 n, c]."""
    halves = (run.own, run.reference) if run.reference else (run.own,)
    chosen = [x[:, frame] for frames in zip(*halves, strict=True) for frame in frames]
    return torch.cat(chosen, dim=1).unflatten(1, (len(run.own), -1)).flatten(0, 1)


def _half_bias(bias: float, x: Tensor) -> Tensor:
    """Bias of the second half of twice as many keys as x has tokens, shape [1, 1, n, 2 n] without storage for n."""
    tokens = x.shape[1]
    row = torch.cat([x.new_zeros(tokens), x.new_full((tokens,), bias)])
    return row.expand(1, 1, tokens, -1)
