"""How much memory networks and their work need, and how much was used."""

from __future__ import annotations

import importlib.util
import sys

import torch
from torch import nn

__all__ = ["autoencoder_bytes", "bytes_of", "peak_memory", "sampling_bytes"]

_SAMPLING_COPIES = 40
"""So many tensors of the first level's size live at once in the UNet: skips, keys and values, gated layers.

``tests/benchmarks/svd.py`` counts 34.8 at both sizes that it knows; 40 leaves 15 % of room.
"""

_AUTOENCODER_COPIES = 8
"""So many tensors of full resolution live at once in the autoencoder, as ``tests/benchmarks/svd.py`` counts them."""


def bytes_of(network: nn.Module) -> int:
    """Memory of the network's weights."""
    return sum(each.numel() * each.element_size() for each in (*network.parameters(), *network.buffers()))


def sampling_bytes(latents: int, channels: int, dtype: torch.dtype) -> int:
    """Memory of one prediction, roughly.

    Args:
        latents: places of all frames of a segment together.
        channels: of the UNet's first level.
        dtype: in which it computes.
    """
    return _SAMPLING_COPIES * latents * channels * dtype.itemsize


def autoencoder_bytes(pixels: int, channels: int) -> int:
    """Memory of encoding or decoding, roughly.

    Args:
        pixels: of all pictures together.
        channels: of the autoencoder's first level.
    """
    return _AUTOENCODER_COPIES * pixels * channels * torch.float32.itemsize


def peak_memory(device: torch.device) -> int:
    """Most bytes so far: of tensors on a GPU since its statistics were last reset, of the process elsewhere.

    Systems that do not count it (Windows) give 0.
    """
    if device.type == "cuda":
        return torch.cuda.max_memory_allocated(device)
    if importlib.util.find_spec("resource") is None:
        return 0
    import resource

    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * 1024
