"""What a worker of our own does when it begins."""

from __future__ import annotations

import signal
from typing import Any

from distributed import WorkerPlugin

__all__ = ["LeavesInterruptions"]


class LeavesInterruptions(WorkerPlugin):
    """Ctrl+C reaches all processes of a terminal: the first one hears it, and ends its workers."""

    def setup(self, worker: Any) -> None:
        """Ignore it here."""
        signal.signal(signal.SIGINT, signal.SIG_IGN)
