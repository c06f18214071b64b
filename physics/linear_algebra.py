"""One thread for linear algebra, while this process works on matrices like ours.

They are sparse, and what is dense in their factors and bases is small. NumPy and SciPy give such products to as many
threads as there are cores, which mostly wait for each other then, and keep the cores from other work by doing so: on
two cores the example took 10.4 s of processor time and 6.5 s altogether so, and takes 8.1 and 5.6 s without.
"""

from __future__ import annotations

import os
import sys
import threading
from contextlib import ContextDecorator, ExitStack
from functools import lru_cache
from typing import Any

__all__ = ["THREADS_OF_ALGEBRA", "begin_on_one_thread", "on_one_thread"]

THREADS_OF_ALGEBRA = "OPENBLAS_NUM_THREADS"
"""Environment variable that says how many threads OpenBLAS, which NumPy and SciPy bring, begins with."""


def begin_on_one_thread() -> None:
    """Let OpenBLAS have one thread in this process and those that it starts, unless it is loaded or told otherwise.

    For a process of our own: threads that are never begun cost least.
    """
    if "numpy" not in sys.modules:
        os.environ.setdefault(THREADS_OF_ALGEBRA, "1")


class _OnOneThread(ContextDecorator):
    """Of blocks of several threads that overlap the first one counts, as long as it lasts.

    The number of threads is the whole process's: were each to bring back what it had found, the last one to leave would
    bring back the one thread of another.
    """

    def __init__(self) -> None:
        self._lock, self._thread, self._depth, self._limits = threading.Lock(), 0, 0, ExitStack()

    def __enter__(self) -> None:
        if os.environ.get(THREADS_OF_ALGEBRA) == "1":
            return
        libraries, this = _libraries(), threading.get_ident()
        with self._lock:
            if not self._depth:
                self._thread = this
                self._limits.enter_context(libraries.limit(limits=1))
            self._depth += self._thread == this

    def __exit__(self, *_error: object) -> None:
        with self._lock:
            if self._depth and self._thread == threading.get_ident():
                self._depth -= 1
                if not self._depth:
                    self._limits.close()


on_one_thread = _OnOneThread()
"""A block, or decorator, in which OpenBLAS uses one thread in this process."""


@lru_cache(maxsize=1)
def _libraries() -> Any:
    """OpenBLAS as NumPy and SciPy have loaded it; no other library of algebra, such as PyTorch's."""
    import scipy.sparse.linalg  # noqa: F401  (loads the last of them)
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController().select(internal_api="openblas")
