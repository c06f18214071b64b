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

__all__ = [
    "CACHE_LINE",
    "FIRST_PHASE",
    "TRIANGLES_PER_THREAD",
    "Pace",
    "counters",
    "launch_faster",
    "most_threads",
    "share_counters",
]

TRIANGLES_PER_THREAD = 400
"""A smaller share of a part is not worth a thread's while: all threads wait for each other twice in every substep.

Two threads compute 1,000 triangles 1.5 times as fast as one, 5,000 1.8 times and 50,000 1.9 times, where no other
program has the processors.
"""

MOST_THREADS = 8
"""More threads wait longer for each other than they compute."""

FIRST_PHASE = 2
"""Counter of the pieces that are claimed in the first phase; those before count pieces that are done."""

CACHE_LINE = 32
"""Numbers that processors take from each other together, in two lines of 64 bytes side by side."""

_TRY_AGAIN = 16  # launches after which the slower way is tried once more
_AT_FIRST = 3  # measurements of each way before one is chosen, of which the best counts
_LATEST = 0.5  # weight of the latest measurement
_MEASURED = 0.01  # time of launches together that tells a speed [s]: in a short one threads have to wake up


class Pace:
    """The speed of both ways, shared and not, in the last launches of a kernel on work of one size."""

    def __init__(self) -> None:
        self._speeds = {True: math.inf, False: math.inf}  # what is untried may be the fastest
        self._launches = 0
        self._compiled = {True: False, False: False}
        self._measured = {True: 0, False: 0}
        self._work, self._seconds = {True: 0.0, False: 0.0}, {True: 0.0, False: 0.0}  # since the last measurement

    def share(self) -> bool:
        """Whether to share the work in the next launch."""
        self._launches += 1
        for shared in (True, False):
            if self._measured[shared] < _AT_FIRST:
                return shared
        faster = self._speeds[True] >= self._speeds[False]
        return faster != (self._launches % _TRY_AGAIN == 0)

    def learn(self, *, shared: bool, work: float, seconds: float) -> None:
        """Take note of a launch: triangle updates, and the time that they took [s]."""
        if not self._compiled[shared]:  # that took its time, too
            self._compiled[shared] = True
            return
        self._work[shared] += work
        self._seconds[shared] += seconds
        if self._seconds[shared] < _MEASURED:
            return
        before, now = self._speeds[shared], self._work[shared] / self._seconds[shared]
        self._work[shared] = self._seconds[shared] = 0.0
        self._measured[shared] += 1
        if self._measured[shared] == 1:
            self._speeds[shared] = now
        elif self._measured[shared] <= _AT_FIRST:  # others disturb now and then, and only ever for the worse
            self._speeds[shared] = max(before, now)
        else:
            self._speeds[shared] = before + _LATEST * (now - before)


_paces: dict[tuple[str, int], Pace] = {}  # by kernel and size of the work; used on the Taichi thread only


def most_threads(triangles: int, share: int = TRIANGLES_PER_THREAD, spared: int = 0) -> int:
    """Threads that may compute so many triangles: at most as many as this process may use.

    Args:
        triangles: of all threads together.
        share: triangles of a thread, at least.
        spared: processors that are left to others.
    """
    return max(1, min(allowed_threads() - spared, MOST_THREADS, triangles // share))


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


def share_counters(threads: int, substeps: int, ticks: int) -> NDArray[np.int32]:
    """The counters of a launch in which each thread has a share of its own.

    Two lines of the cache of each thread: one for pieces that it has done; then for each thread and phase one of
    pieces of its share that are claimed.

    Args:
        threads: that share the work.
        substeps: planned in a tick; each has two phases.
        ticks: in the launch.
    """
    phases = 2 * MOST_REFINEMENT * substeps * ticks
    lines = 1 + -(-phases // CACHE_LINE)
    return np.zeros((2 + lines) * CACHE_LINE * threads, dtype=np.int32)


def counters(substeps: int, ticks: int) -> NDArray[np.int32]:
    """The counters of a launch: two of pieces that are done, then for each phase one of pieces that are claimed.

    Args:
        substeps: planned in a tick, the most of all parts.
        ticks: in each of which there are at most four phases besides the two of a substep; one precedes all.
    """
    return np.zeros(FIRST_PHASE + 1 + ticks * (4 + 2 * MOST_REFINEMENT * substeps), dtype=np.int32)
