"""What the scheduler of our own cluster does besides."""

from __future__ import annotations

from typing import Any

from distributed import SchedulerPlugin

__all__ = ["LetsNewWorkersHelp"]


class LetsNewWorkersHelp(SchedulerPlugin):
    """Where all workers have gone, a new one does what was meant for them, which Dask would let wait for ever."""

    def add_worker(self, scheduler: Any, worker: str) -> None:
        """Called before the new worker gets what waits."""
        for task in scheduler.unrunnable:
            if task.loose_restrictions:
                task.worker_restrictions = None
