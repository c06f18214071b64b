"""AdamW with a learning rate that warms up, in full precision or with moments of 8 bits."""

from __future__ import annotations

from collections.abc import Iterable

import torch
from torch import nn

from ...physics.errors import InvalidInputError
from .settings import TrainingSettings

__all__ = ["learning_rate", "made_optimizer", "set_learning_rate"]


def made_optimizer(
    parameters: Iterable[nn.Parameter], settings: TrainingSettings, device: torch.device
) -> torch.optim.Optimizer:
    """AdamW (Loshchilov and Hutter 2019).

    Raises:
        InvalidInputError: moments of 8 bits are asked for, and cannot be had here.
    """
    rate, decay = settings.learning_rate, settings.weight_decay
    if not settings.eight_bit:
        return torch.optim.AdamW(parameters, lr=rate, weight_decay=decay)
    if device.type != "cuda":
        raise InvalidInputError(f"eight_bit must be false where there is no CUDA device. Got: true, on {device.type}")
    try:
        from bitsandbytes.optim import AdamW8bit
    except ImportError:
        raise InvalidInputError(
            "eight_bit must be false without bitsandbytes (pip install bitsandbytes). Got: true"
        ) from None
    return AdamW8bit(parameters, lr=rate, weight_decay=decay)  # type: ignore[no-any-return]


def learning_rate(step: int, settings: TrainingSettings) -> float:
    """Of a step, from 0: it rises in equal parts over the warm-up."""
    return settings.learning_rate * min(1.0, (step + 1) / max(settings.warmup, 1))


def set_learning_rate(optimizer: torch.optim.Optimizer, rate: float) -> None:
    """Of all parameters."""
    for group in optimizer.param_groups:
        group["lr"] = rate
