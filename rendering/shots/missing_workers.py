"""Says when shots wait because no worker is left that could do them: with a cluster, machines come and go."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ...physics.errors import counted
from .cluster import GPU

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["GPU_WORKERS", "missing_workers_told", "workers_of"]

GPU_WORKERS = "one with a graphics card, dask worker --resources 'GPU=1'"
"""What shots with networks wait for."""

_LOOK = 2.0  # [s] between two looks; a worker that is begun again at once is not missed


def workers_of(client: Client, *, on_gpu: bool) -> list[Mapping[str, Any]]:
    """What is known of each worker that can do shots of a kind.

    Raises:
        OSError: the scheduler does not answer.
    """
    workers = client.scheduler_info(n_workers=-1)["workers"].values()
    return [each for each in workers if not on_gpu or each.get("resources", {}).get(GPU)]


@contextmanager
def missing_workers_told(
    client: Client, left: Callable[[bool], int], tell: Callable[[str], None], *, look: float = _LOOK
) -> Iterator[None]:
    """Meanwhile, tell when the last worker that could do what is left has gone, and when one has come.

    Args:
        client: of the cluster.
        left: how many shots have not ended, of those with networks on a graphics card (True) or of the others.
        tell: called with a sentence, in another thread.
        look: seconds between two looks.
    """
    ended = threading.Event()

    def watch() -> None:
        missed = {True: 0, False: 0}  # how many looks in turn
        while not ended.wait(look):
            for on_gpu in missed:
                try:
                    there = bool(workers_of(client, on_gpu=on_gpu))
                except Exception:  # the scheduler is gone, which the first thread tells
                    return
                count = left(on_gpu)
                if there and missed[on_gpu] > 1:
                    tell(f"a worker has come for {_shots(count, on_gpu)}")
                missed[on_gpu] = missed[on_gpu] + 1 if count and not there else 0
                if missed[on_gpu] == 2:
                    tell(f"no worker is left: {_shots(count, on_gpu)} wait for {_wanted(on_gpu)}")

    thread = threading.Thread(target=watch, name="physanimator-workers", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()


def _shots(count: int, on_gpu: bool) -> str:
    return counted(count, "shot") + (" with networks" if on_gpu else "")


def _wanted(on_gpu: bool) -> str:
    return GPU_WORKERS if on_gpu else "another one"
