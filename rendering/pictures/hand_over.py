"""Pictures handed over from the thread that draws them to one that writes them, so that both work at once."""

from __future__ import annotations

import queue
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar

from ...physics.beside import Beside
from ...physics.interruption import checkpoint
from ...physics.threads import allowed_threads
from ..files import removed_at_signals

__all__ = ["consumed_beside"]

T = TypeVar("T")

_POLL_SECONDS = 0.2
_END = object()


def consumed_beside(items: Iterable[T], consume: Callable[[Iterator[T]], None], *, ahead: int = 2) -> None:
    """Call ``consume`` in a thread of its own with what ``items`` gives, which is made in this one meanwhile.

    The first error on either side ends both, and is raised here when nothing of ``consume`` runs any more. Where this
    process may use one thread only, both are done in turns in that.

    Args:
        items: made one after another by the calling thread, in which signals are heard.
        consume: reads all of them; where an error ends the work, its iterator raises, so that it can clean up.
        ahead: how many may wait to be consumed.
    """
    if allowed_threads() == 1:
        consume(_in_turns(items))
        return
    handed: queue.Queue[Any] = queue.Queue(ahead)
    with removed_at_signals(), Beside(lambda: consume(_arriving(handed))) as consumer:
        for item in items:
            if not _put(handed, item, consumer):
                break
        _put(handed, _END, consumer)
        consumer.result()


def _in_turns(items: Iterable[T]) -> Iterator[T]:
    """Each item when it is asked for; may be stopped at checkpoints."""
    for item in items:
        checkpoint()
        yield item


def _put(handed: queue.Queue[Any], item: object, consumer: Beside[None]) -> bool:
    """Hand something over, when there is room; False if nobody takes it any more."""
    while not consumer.ended:
        try:
            handed.put(item, timeout=_POLL_SECONDS)
        except queue.Full:
            continue
        return True
    return False


def _arriving(handed: queue.Queue[Any]) -> Iterator[Any]:
    """What is handed over, in turn; may be stopped at checkpoints."""
    while True:
        checkpoint()
        try:
            item = handed.get(timeout=_POLL_SECONDS)
        except queue.Empty:
            continue
        if item is _END:
            return
        yield item
