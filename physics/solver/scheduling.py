"""Which connected parts are computed side by side, and which by several threads together."""

from __future__ import annotations

import os
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["TRIANGLES_PER_THREAD", "Schedule", "most_threads", "schedule"]

TRIANGLES_PER_THREAD = 750
"""Smallest share of a part that is worth a thread's while: threads meet twice in a substep, for a microsecond."""

_EFFICIENCY = 0.7
"""Of threads that share a part: two compute 2,000 triangles 1.4 times as fast as one, and 50,000 1.7 times."""

_MOST_THREADS = 8  # that meet; more wait longer than they work


class Schedule(NamedTuple):
    """How the parts of a solid are computed.

    Attributes:
        alone: parts that one thread computes, the most work first, int32.
        shared: pairs of a part that several threads compute together, and how many these are.
    """

    alone: NDArray[np.int32]
    shared: tuple[tuple[int, int], ...]


def schedule(triangles: NDArray[np.integer], substeps: NDArray[np.integer], *, threads: int | None = None) -> Schedule:
    """Choose for each connected part.

    A part is shared when it is large enough, and when all would otherwise wait for it in the end.

    Args:
        triangles: of each part, shape [p].
        substeps: of each part in a tick, shape [p].
        threads: most threads; one for each processor that this process may use when None.
    """
    threads = most_threads() if threads is None else min(threads, _MOST_THREADS)
    work = triangles.astype(np.float64) * substeps
    shares = np.minimum(triangles // TRIANGLES_PER_THREAD, threads)
    together = work / (_EFFICIENCY * np.maximum(shares, 1)) + (work.sum() - work) / threads
    large = (shares > 1) & (together < np.maximum(work, work.sum() / threads))
    alone = np.flatnonzero(~large)
    shared = tuple((int(part), int(shares[part])) for part in np.flatnonzero(large))
    return Schedule(alone[np.argsort(-work[alone], kind="stable")].astype(np.int32), shared)


def most_threads() -> int:
    """Threads that are worth having: one for each processor that this process may use, but not too many."""
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(available, _MOST_THREADS)
