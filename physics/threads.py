"""How many threads this process may use: one for each of the machine's cores, unless it is one of many.

A process that works beside others, such as a worker that does one shot of a list, keeps to the cores that are its own:
threads that share a core wait for each other. Results never depend on the number, only the time they take.
"""

from __future__ import annotations

import os

from .errors import require

__all__ = [
    "THREADS",
    "allowed_threads",
    "chosen_threads",
    "keep_to_threads",
    "thread_variables",
    "usable_cores",
]

THREADS = "PHYSANIMATOR_THREADS"
"""Environment variable that says how many; processes that this one starts inherit it."""

_MOST = 1024
_LIBRARIES = ("OPENCV_FOR_THREADS_NUM", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")


def allowed_threads() -> int:
    """How many threads may compute at once in this process.

    Raises:
        InvalidInputError: the environment variable ``PHYSANIMATOR_THREADS`` is no such number.

    Examples:
        >>> from physanimator.physics.threads import allowed_threads
        >>> allowed_threads() >= 1
        True
    """
    return chosen_threads() or usable_cores()


def chosen_threads() -> int | None:
    """What ``PHYSANIMATOR_THREADS`` says; None where it says nothing.

    Raises:
        InvalidInputError: it is no number from 1 to 1024.
    """
    said = os.environ.get(THREADS, "").strip()
    if not said:
        return None
    threads = int(said) if said.isascii() and said.isdigit() else 0
    require(f"the environment variable {THREADS}", said, 1 <= threads <= _MOST, f"1 to {_MOST}")
    return threads


def usable_cores() -> int:
    """Cores that the system lets this process use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def thread_variables(threads: int) -> dict[str, str]:
    """Environment variables of a process that keeps to so many threads; what libraries are told already stays."""
    return {THREADS: str(threads), **{name: os.environ.get(name, str(threads)) for name in _LIBRARIES}}


def keep_to_threads(threads: int) -> None:
    """Let this process, and those that it starts, keep to so many threads from now on."""
    os.environ.update(thread_variables(threads))
    import cv2  # which reads them

    cv2.setNumThreads(threads)
