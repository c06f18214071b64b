"""What callers hand over as an array: NumPy's own, a tensor of torch, a Pillow picture, nested lists."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import InvalidInputError

__all__ = ["OVERSHOOT", "as_array", "beyond_one"]

OVERSHOOT = 0.25
"""How far values may lie beyond 0 to 1 and still be that range: bicubic and Lanczos resampling ring as much."""


def as_array(values: Any, name: str) -> NDArray[Any]:
    """Numbers as an array of booleans, whole or floating-point numbers; shares memory where it can.

    Args:
        values: a NumPy array, a tensor on any device, a Pillow picture, or nested lists.
        name: what the caller calls it, for messages.

    Raises:
        InvalidInputError: it holds anything else.
    """
    if hasattr(values, "detach") and hasattr(values, "cpu"):
        values = values.detach().cpu()
        values = values.float() if "bfloat16" in str(getattr(values, "dtype", "")) else values
    try:
        array = np.asarray(values)
    except (TypeError, ValueError, RuntimeError, OverflowError) as error:
        raise InvalidInputError(f"{name} must be an array of numbers. Got: {type(values).__name__}") from error
    if array.dtype.kind not in "biuf":
        kind = f"dtype {array.dtype}" if array.ndim else type(values).__name__
        raise InvalidInputError(f"{name} must hold booleans, integers or floating-point numbers. Got: {kind}")
    return array


def beyond_one(low: float, high: float) -> str:
    """What is to be said of floating-point numbers that are not 0 to 1, to stand after "must hold"."""
    remedy = "; divide by 255" if low >= -OVERSHOOT and high <= 256 else ""
    return f"floating-point numbers from 0 to 1. Got: {low:.4g} to {high:.4g}{remedy}"
