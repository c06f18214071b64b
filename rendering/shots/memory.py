"""How a worker's C library deals with memory: it keeps what a picture took for the next one."""

from __future__ import annotations

import sys
from functools import lru_cache

__all__ = ["MEMORY_KEPT", "keep_memory"]

_TRIM, _MAPPED = 1 << 28, 1 << 25  # bytes
MEMORY_KEPT = {"MALLOC_TRIM_THRESHOLD_": str(_TRIM), "MALLOC_MMAP_THRESHOLD_": str(_MAPPED)}
"""Environment variables that have it so from the start of a process."""

_M_TRIM_THRESHOLD, _M_MMAP_THRESHOLD = -1, -3  # numbers of malloc.h


@lru_cache(maxsize=1)
def keep_memory() -> None:
    """Have it so from now on. Dask has its workers give memory back at once: each picture is mapped anew then, and each
    page of it cleared, 30 % of the processor time. Nothing on systems whose C library has no such choice.
    """
    if sys.platform != "linux":
        return
    import ctypes

    choose = getattr(ctypes.CDLL(None), "mallopt", None)  # not every C library has it
    if choose is not None:
        choose(_M_TRIM_THRESHOLD, _TRIM)
        choose(_M_MMAP_THRESHOLD, _MAPPED)
