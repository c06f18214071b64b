"""What a worker of our own does when it begins."""

from __future__ import annotations

import signal
from typing import Any

from distributed import WorkerPlugin

from ...physics.threads import chosen_threads, keep_to_threads

__all__ = ["KeepsToItself"]


class KeepsToItself(WorkerPlugin):
    """Keeps to its own cores, and leaves Ctrl+C, which reaches all processes of a terminal, to the first one."""

    def setup(self, worker: Any) -> None:
        """Do so from now on."""
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        keep_to_threads(chosen_threads() or 1)
