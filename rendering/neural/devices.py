"""Where networks compute, and how exactly, where no host says so."""

from __future__ import annotations

import torch

from ...physics.errors import InvalidInputError, require
from ..networks.memory import peak_memory
from ..networks.placement import Placement
from .options import NetworkOptions

__all__ = ["device_of", "dtype_of", "most_memory", "placement_on"]

_TYPES = {"fp32": torch.float32, "fp16": torch.float16, "bf16": torch.bfloat16}


def device_of(name: str) -> torch.device:
    """The device of a name; "auto" is the first GPU that CUDA or ROCm finds, else the CPU.

    Raises:
        InvalidInputError: there is no such device here.
    """
    if name == "auto":
        return torch.device("cuda" if torch.cuda.is_available() else "cpu")
    try:
        device = torch.device(name)
        torch.zeros(1, device=device).cpu()
    except Exception as error:  # which one depends on the device and on how torch was built
        found = "auto, cpu" + "".join(f", cuda:{number}" for number in range(torch.cuda.device_count()))
        raise InvalidInputError(f"device must be one that torch finds here, such as {found}. Got: {name!r}") from error
    return device


def dtype_of(name: str, device: torch.device) -> torch.dtype:
    """The type of an entry of ``DTYPES`` on a device.

    Raises:
        InvalidInputError: the device does not compute with it.
    """
    if name == "auto":
        return torch.float16 if device.type == "cuda" else torch.float32
    dtype = _TYPES[name]
    bf16 = dtype == torch.bfloat16 and device.type == "cuda" and not torch.cuda.is_bf16_supported()
    require("dtype", name, not bf16, f"fp16 or fp32 on {device}, which does not compute with bf16")
    return dtype


def placement_on(device: torch.device) -> Placement:
    """The device for networks that come to it one after another; memory of a GPU is given back between them."""
    return Placement(device, left=torch.cuda.empty_cache) if device.type == "cuda" else Placement(device)


def most_memory(options: NetworkOptions) -> tuple[str, str]:
    """The device, and the most memory that was used on it, or by the process where it is the CPU, in words."""
    device = device_of(options.device)
    return str(device), f"{peak_memory(device) / 2**30:.1f} GiB"
