"""In which precision networks compute inside the host."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import torch

__all__ = ["PRECISIONS", "dtype_of"]

PRECISIONS = ("auto", "fp16", "bf16", "fp32")


def dtype_of(precision: str, device: torch.device) -> torch.dtype:
    """The type that an entry of ``PRECISIONS`` means on a device."""
    import torch
    from comfy import model_management

    if precision == "auto":
        halves = model_management.should_use_fp16(device)
        precision = "fp16" if halves else "bf16" if model_management.should_use_bf16(device) else "fp32"
    return {"fp16": torch.float16, "bf16": torch.bfloat16, "fp32": torch.float32}[precision]
