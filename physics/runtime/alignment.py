"""Arrays at addresses from which the kernels can load vectors."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

__all__ = ["LANES", "aligned", "check_aligned"]

LANES = 16
"""Triangles that are computed together, one in each lane of the processor's vectors.

Wider than most processors' vectors, so that two of these are under way at once: 215 million triangles a second with
16 lanes and 178 with 8 on a core with vectors of 8.
"""

_ALIGNMENT = 4 * LANES  # [bytes] that the compiler takes for granted when it loads a vector


def aligned(shape: tuple[int, ...], dtype: DTypeLike = np.float32) -> NDArray[Any]:
    """Zeros at an address from which the kernels can load vectors."""
    size = int(np.prod(shape)) * np.dtype(dtype).itemsize
    room = np.zeros(size + _ALIGNMENT, dtype=np.uint8)
    first = -room.ctypes.data % _ALIGNMENT
    return room[first : first + size].view(dtype).reshape(shape)


def check_aligned(*arrays: NDArray[Any]) -> None:
    """Refuse arrays at other addresses, which would end the process.

    Raises:
        ValueError: there is one.
    """
    for array in arrays:
        if array.size and array.ctypes.data % _ALIGNMENT:
            raise ValueError(f"an array of the solver must come from aligned(). Got: shape {array.shape} elsewhere")
