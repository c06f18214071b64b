"""The end of a process waits for what still works in its threads.

Python stops its daemon threads wherever they are when the process ends. One that is inside a compiled library then is
torn out of it, which ends some processes with an abort or with exit code 120. So whoever works long says so here, and
is told to stop at its next checkpoint; the process goes on with its end when nobody works any more.
"""

from __future__ import annotations

import atexit
import os
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial

from .errors import Cancelled

__all__ = ["stop_at_end", "wait_to_the_end", "working"]

_LAST_SECONDS = 30.0  # that the end of the process waits: no stage is longer between two checkpoints, or few are
_GRACE_SECONDS = 0.5  # and then for those threads themselves: they may be somebody's, which do not end

_changed = threading.Condition()
_at_work: dict[int, int] = {}  # sections by thread
_state = {"ending": False, "process": 0}


@contextmanager
def working() -> Iterator[None]:
    """A section of work for which the end of the process waits, on the calling thread; sections may be nested.

    Raises:
        Cancelled: the process is ending.
    """
    this = threading.get_ident()
    with _changed:
        if _state["process"] != os.getpid():  # the first time, or in a fork, in which no other thread lives
            _at_work.clear()
            if not _state["process"]:
                atexit.register(_finish)
            _state["process"] = os.getpid()
        stop_at_end()
        _at_work[this] = _at_work.get(this, 0) + 1
    try:
        yield
    finally:
        with _changed:
            _at_work[this] -= 1
            if not _at_work[this]:
                del _at_work[this]
            _changed.notify_all()


def stop_at_end() -> None:
    """
    Raises:
        Cancelled: the process is ending, and the calling thread is not the one that ends it.
    """
    if _state["ending"]:
        raise Cancelled("the process is ending")


def wait_to_the_end(wait: Callable[[float], object], seconds: float) -> None:
    """Wait while the process ends, whatever signals come: nobody can be told any more that somebody pressed Ctrl+C.

    Args:
        wait: waits for at most so many seconds; called again where an interrupt has ended it early.
        seconds: how long to wait at most.
    """
    until = time.monotonic() + seconds
    while True:
        try:
            wait(max(0.0, until - time.monotonic()))
        except KeyboardInterrupt:
            continue
        return


def _finish() -> None:
    if _state["process"] != os.getpid():
        return
    this = threading.get_ident()
    with _changed:
        _state["ending"] = True
        stopped = [thread for thread in threading.enumerate() if thread.ident in set(_at_work) - {this}]
        wait_to_the_end(partial(_changed.wait_for, lambda: not set(_at_work) - {this}), _LAST_SECONDS)
    until = time.monotonic() + _GRACE_SECONDS
    for thread in stopped:  # which may still write that it was stopped
        wait_to_the_end(thread.join, until - time.monotonic())
