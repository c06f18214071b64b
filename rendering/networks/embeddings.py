"""Embeddings of single numbers: noise levels, times, micro-conditioning."""

from __future__ import annotations

from diffusers.models.embeddings import get_timestep_embedding
from torch import Tensor, nn

__all__ = ["embedding_layers", "sinusoid"]


def sinusoid(values: Tensor, channels: int) -> Tensor:
    """Cosines, then sines, of falling frequencies.

    Args:
        values: numbers, shape [n].
        channels: number of cosines and sines together.

    Returns:
        float32, shape [n, channels].
    """
    return get_timestep_embedding(values, channels, flip_sin_to_cos=True, downscale_freq_shift=0)


def embedding_layers(channels_in: int, hidden: int, channels_out: int) -> nn.Sequential:
    """Two linear layers with a SiLU between them."""
    return nn.Sequential(nn.Linear(channels_in, hidden), nn.SiLU(), nn.Linear(hidden, channels_out))
