"""Classifier-free guidance (Ho and Salimans 2022), with its contrast brought back (Lin et al. 2023)."""

from __future__ import annotations

from torch import Tensor

__all__ = ["guided"]


def guided(conditional: Tensor, unconditional: Tensor, *, scale: float, rescale: float) -> Tensor:
    """Away from what the network would draw without conditions.

    Args:
        conditional: prediction with the conditions, shape [b, ...].
        unconditional: prediction without, same shape.
        scale: 1 leaves the conditional prediction as it is; more follows the conditions more closely.
        rescale: 0..1, share of the result that gets the conditional prediction's standard deviation.
    """
    mixed = unconditional + scale * (conditional - unconditional)
    inner = tuple(range(1, mixed.ndim))
    contrast = conditional.std(dim=inner, keepdim=True) / mixed.std(dim=inner, keepdim=True)
    return mixed * (rescale * contrast + (1 - rescale))
