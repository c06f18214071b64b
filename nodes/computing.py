"""Where and in which precision networks compute inside the host, and how they get room there."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import torch

    from ..rendering.svd.placement import Placement

__all__ = ["PRECISIONS", "dtype_of", "host_placement"]

PRECISIONS = ("auto", "fp16", "bf16", "fp32")


def dtype_of(precision: str, device: torch.device) -> torch.dtype:
    """The type that an entry of ``PRECISIONS`` means on a device."""
    import torch
    from comfy import model_management

    if precision == "auto":
        halves = model_management.should_use_fp16(device)
        precision = "fp16" if halves else "bf16" if model_management.should_use_bf16(device) else "fp32"
    return {"fp16": torch.float16, "bf16": torch.bfloat16, "fp32": torch.float32}[precision]


def host_placement(device: torch.device) -> Placement:
    """The device, on which the host makes room by sending its own models away."""
    from comfy import model_management

    from ..rendering.svd.placement import Placement

    return Placement(
        device,
        make_room=lambda needed: model_management.free_memory(needed, device) and None,
        left=model_management.soft_empty_cache,
    )
