"""Processes that work for the first one: they end with it, whatever ends it, and leave nothing half done."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any

from ..physics.errors import InvalidInputError
from ..physics.threads import keep_to_threads

__all__ = ["heeding", "stopped_at_the_end"]


@contextmanager
def stopped_at_the_end(pool: ProcessPoolExecutor, stop: Any, *, called: str) -> Iterator[None]:
    """However the block ends, the processes end by themselves and leave nothing half done.

    Args:
        pool: whose processes began with :func:`heeding`.
        stop: a ``multiprocessing`` event that they look at.
        called: the option that says how many there are, for the message.

    Raises:
        InvalidInputError: the system has ended one of them.
    """
    try:
        yield
    except BrokenProcessPool:
        raise InvalidInputError(
            f"{called} must be few enough for the memory. Got: a process that the system ended"
        ) from None
    finally:
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)


def heeding(stop: Any) -> None:
    """Begin a process of a pool: one thread, and an end only by ``stop``.

    Ctrl+C goes to all processes; the first one tells the others, so that they put away what they are at.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda *_: stop.set())
    keep_to_threads(1)
