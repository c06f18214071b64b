"""Taichi in a process that others may use too: its thread, its compiled kernels on disk, and a process of our own."""

from __future__ import annotations

from .alignment import LANES, aligned, check_aligned
from .cache_folder import KernelCache, kernel_cache
from .taichi_runtime import keep_compiled
from .worker import TaichiWorker

__all__ = [
    "LANES",
    "KernelCache",
    "TaichiWorker",
    "aligned",
    "check_aligned",
    "keep_compiled",
    "kernel_cache",
]
