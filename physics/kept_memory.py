"""How a process's C library deals with memory: it keeps what a picture took for the next one."""

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
    """Have it so from now on, in a process that is ours and not a host's or a user's.

    Otherwise much of what a picture takes is given back at once and mapped anew for the next one, each page of it
    cleared: 5 % of a command's processor time, and 30 % of a worker's, whose memory Dask has given back at once.
    Nothing on systems whose C library has no such choice.
    """
    if sys.platform != "linux":
        return
    import ctypes

    choose = getattr(ctypes.CDLL(None), "mallopt", None)  # not every C library has it
    if choose is not None:
        choose(_M_TRIM_THRESHOLD, _TRIM)
        choose(_M_MMAP_THRESHOLD, _MAPPED)
