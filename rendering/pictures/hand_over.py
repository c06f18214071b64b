"""Pictures handed over from the thread that draws them to one that writes them, so that both work at once."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar

from ...physics.interruption import interruptible

__all__ = ["consumed_beside"]

T = TypeVar("T")

_POLL_SECONDS = 0.2  # without a timeout Windows would not deliver Ctrl+C
_END = object()


class _GivenUp(Exception):
    """Nothing more will come."""


def consumed_beside(items: Iterable[T], consume: Callable[[Iterator[T]], None], *, ahead: int = 2) -> None:
    """Call ``consume`` in a thread of its own with what ``items`` gives, which is made in this one meanwhile.

    The first error on either side ends both, and is raised here when nothing of ``consume`` runs any more.

    Args:
        items: made one after another by the calling thread, in which signals are heard.
        consume: reads all of them. When an error ends the work, its iterator raises, and so do its checkpoints (see
            :func:`~physanimator.physics.interruption.checkpoint`), so that it can clean up.
        ahead: how many may wait to be consumed.
    """
    work = _Work(ahead)
    failures: list[BaseException] = []

    def run() -> None:
        try:
            with interruptible(work.check):
                consume(work.arriving())
        except _GivenUp:
            pass
        except BaseException as error:  # raised in the other thread, whatever it is
            failures.append(error)
        finally:
            work.ended.set()

    # No daemon: the process must not end inside of a compiled library.
    thread = threading.Thread(target=run, name="physanimator-writing")
    thread.start()
    try:
        for item in items:
            if not work.put(item):
                break
        work.put(_END)
        _join(thread)
    except BaseException:
        work.given_up.set()
        _join(thread)
        raise
    if failures:
        raise failures[0]


class _Work:
    """What both threads know of each other."""

    def __init__(self, ahead: int) -> None:
        self.handed: queue.Queue[Any] = queue.Queue(ahead)
        self.maker, self.ended, self.given_up = threading.current_thread(), threading.Event(), threading.Event()

    def put(self, item: object) -> bool:
        """Hand something over, when there is room; False if nobody takes it any more."""
        while not self.ended.is_set():
            try:
                self.handed.put(item, timeout=_POLL_SECONDS)
            except queue.Full:
                continue
            return True
        return False

    def arriving(self) -> Iterator[Any]:
        """What is handed over, in turn."""
        while True:
            self.check()
            try:
                item = self.handed.get(timeout=_POLL_SECONDS)
            except queue.Empty:
                continue
            if item is _END:
                return
            yield item

    def check(self) -> None:
        """Stop here if the other thread has given up, or a second signal has torn it out of doing so."""
        if self.given_up.is_set() or not self.maker.is_alive():
            raise _GivenUp


def _join(thread: threading.Thread) -> None:
    while thread.is_alive():
        thread.join(_POLL_SECONDS)
