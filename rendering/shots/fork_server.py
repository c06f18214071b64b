"""The process from which workers are forked: it imports once what all of them need, while others are still busy."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from ...physics.kept_memory import MEMORY_KEPT
from ...physics.threads import thread_variables

__all__ = ["FORKS", "begin_fork_server"]

FORKS = sys.platform == "linux"
"""Whether workers are forked. Windows cannot, and system libraries of macOS do not live through it."""


def begin_fork_server(module: str) -> None:
    """Start it, where workers are forked, and do not wait until it has imported; nothing where it is there already.

    It keeps to one thread: processes with several cannot be forked safely. Its workers may have more.

    Args:
        module: imports what workers need, and nothing that has a thread, such as Taichi's runtime.
    """
    if not FORKS:
        return
    from multiprocessing import forkserver

    kept = {name: os.environ.get(name, value) for name, value in MEMORY_KEPT.items()}
    forkserver.set_forkserver_preload([module])
    with _environment({**kept, **dict.fromkeys(thread_variables(1), "1")}), _without_interruptions():
        forkserver.ensure_running()


@contextmanager
def _environment(variables: dict[str, str]) -> Iterator[None]:
    """Variables that processes inherit which are started meanwhile."""
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextmanager
def _without_interruptions() -> Iterator[None]:
    """Processes that are started meanwhile leave Ctrl+C, which reaches all of a terminal, to this one."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL if before is None else before)  # None: not set from Python
