"""Decoding in half precision on a GPU, and in single precision where half overflows."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor

__all__ = ["decoded_in", "is_halved"]


def is_halved(dtype: torch.dtype, device: torch.device) -> bool:
    """Whether an autoencoder, whose weights are float32, computes in a half type: on a GPU alone."""
    return dtype != torch.float32 and device.type == "cuda"


def decoded_in(dtype: torch.dtype, device: torch.device, decode: Callable[[], Tensor]) -> Tensor:
    """The pictures that ``decode`` gives, float32, computed in ``dtype`` where that pays and is exact enough."""
    if not is_halved(dtype, device):
        return decode()
    with torch.autocast(device.type, dtype):
        pictures = decode().float()
    # Half precision overflows for some pictures.
    return pictures if pictures.isfinite().all() else decode()
