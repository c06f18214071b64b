"""Whether threads that share their work get on faster than one: measured, since other programs change it.

Threads that share parts wait for each other in every substep. Where another program has one of the processors, they
wait for its turn to end, and one thread alone is up to three times as fast.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..threads import allowed_threads
from .stepping import MOST_REFINEMENT

__all__ = ["FIRST_PHASE", "Pace", "counters", "launch_faster", "most_threads"]

TRIANGLES_PER_THREAD = 1_000
"""A smaller share of a part is not worth a thread's while: all threads wait for each other twice in every substep.

Two threads compute 2,000 triangles 1.4 times as fast as one, 10,000 1.5 times and 50,000 1.6 times, where no other
program has the processors.
"""

MOST_THREADS = 8
"""More threads wait longer for each other than they compute."""

FIRST_PHASE = 2
"""Counter of the pieces that are claimed in the first phase; those before count pieces that are done."""

_TRY_AGAIN = 16  # launches after which the slower way is tried once more
_LATEST = 0.5  # weight of the latest launch


class Pace:
    """The speed of both ways, shared and not, in the last launches of a kernel on work of one size."""

    def __init__(self) -> None:
        self._speeds = {True: math.inf, False: math.inf}  # what is untried may be the fastest
        self._launches = 0
        self._compiled = {True: False, False: False}

    def share(self) -> bool:
        """Whether to share the work in the next launch."""
        self._launches += 1
        faster = self._speeds[True] >= self._speeds[False]
        return faster != (self._launches % _TRY_AGAIN == 0)

    def learn(self, *, shared: bool, work: float, seconds: float) -> None:
        """Take note of a launch: triangle updates, and the time that they took [s]."""
        if not self._compiled[shared]:  # that took its time, too
            self._compiled[shared] = True
            return
        before, now = self._speeds[shared], work / max(seconds, 1e-9)
        self._speeds[shared] = now if before == math.inf else before + _LATEST * (now - before)


_paces: dict[tuple[str, int], Pace] = {}  # by kernel and size of the work; used on the Taichi thread only


def most_threads(triangles: int, share: int = TRIANGLES_PER_THREAD) -> int:
    """Threads that may compute so many triangles: at most as many as this process may use.

    Args:
        triangles: of all threads together.
        share: triangles of a thread, at least.
    """
    return max(1, min(allowed_threads(), MOST_THREADS, triangles // share))


def launch_faster(launch: Callable[[int], float], *, threads: int, kernel: str, triangles: int) -> None:
    """Launch a kernel with one thread or with several, whichever was faster lately.

    Args:
        launch: called with the number of threads; returns the triangle updates that it has done.
        threads: that there may be.
        kernel: whose speed it is that was measured.
        triangles: on which it works; others have other speeds.
    """
    if threads == 1:
        launch(1)
        return
    pace = _paces.setdefault((kernel, triangles.bit_length()), Pace())
    shared, start = pace.share(), time.perf_counter()
    work = launch(threads if shared else 1)
    pace.learn(shared=shared, work=work, seconds=time.perf_counter() - start)


def counters(substeps: int, ticks: int) -> NDArray[np.int32]:
    """The counters of a launch: two of pieces that are done, then for each phase one of pieces that are claimed.

    Args:
        substeps: planned in a tick, the most of all parts.
        ticks: in each of which there are at most four phases besides the two of a substep; one precedes all.
    """
    return np.zeros(FIRST_PHASE + 1 + ticks * (4 + 2 * MOST_REFINEMENT * substeps), dtype=np.int32)
