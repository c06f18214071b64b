"""Records between the thread that simulates and the one that sends, with room for few."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable

__all__ = ["RecordQueue"]

_QUEUE_BYTES = 2 * 2**20
_POLL_SECONDS = 0.02


class RecordQueue:
    """Records on their way from the simulating thread to the one that sends them; it never holds many."""

    def __init__(self, wake: Callable[[], None], *, max_bytes: int = _QUEUE_BYTES) -> None:
        """
        Args:
            wake: called, from the simulating thread, when there is something to take.
            max_bytes: above which ``put`` waits.
        """
        self._wake, self._max_bytes = wake, max_bytes
        self._records: deque[bytes] = deque()
        self._bytes, self._closed = 0, False
        self._changed = threading.Condition()

    def put(self, data: bytes, check: Callable[[], None]) -> None:
        """Add a record; waits while the queue is full.

        Args:
            data: the record.
            check: called while it waits; may raise to stop.
        """
        with self._changed:
            while self._bytes and self._bytes + len(data) > self._max_bytes:
                check()
                self._changed.wait(_POLL_SECONDS)
            self._append(data)
        self._wake()

    def close(self, last: bytes = b"") -> None:
        """Add a last record, whether there is room or not; no more will come."""
        with self._changed:
            self._append(last)
            self._closed = True
        self._wake()

    def take(self) -> tuple[bytes, bool]:
        """Everything that waits, and whether that was the last; never waits itself."""
        with self._changed:
            data, closed = b"".join(self._records), self._closed
            self._records.clear()
            self._bytes = 0
            self._changed.notify_all()
        return data, closed

    def _append(self, data: bytes) -> None:
        self._records.append(data)
        self._bytes += len(data)
