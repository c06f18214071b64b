"""The Dask cluster that does the work: one of our own on this machine, or one that is running."""

from __future__ import annotations

import importlib.util
import logging
import os
import warnings
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Any

from ...physics.errors import InvalidInputError, require
from ...physics.threads import chosen_threads, thread_variables
from ..files import uninterrupted
from .fork_server import FORKS, begin_fork_server
from .job import MOST_RUNS

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["GPU", "check_installed", "connected", "local_cluster", "threads_each", "usual_workers"]

GPU = "GPU"
"""Dask's resource of which a worker with a graphics card has 1."""

_MEMORY = 5 << 28  # bytes that a shot takes: 1.24 GB of a picture of 3840 x 2160
_MOST_WORKERS = 1024
_CONNECT_SECONDS = 20
# What Dask sets so that workers give memory back at once: each picture is mapped anew then, 30 % of the processor time.
_TRIMMED = "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_"
_METHOD = "distributed.worker.multiprocessing-method"
_PROFILED = "distributed.worker.profile.enabled"  # a look at what workers do, every 10 ms
_PER_CARD = "CUDA_VISIBLE_DEVICES"


def check_installed() -> None:
    """
    Raises:
        InvalidInputError: Dask is not installed.
    """
    missing = [each for each in ("dask", "distributed") if importlib.util.find_spec(each) is None]
    if missing:
        raise InvalidInputError(
            f"shots on several processes need Dask: pip install 'physanimator[shots]', or --workers 0. Got: no"
            f" {missing[0]}"
        )


def usual_workers() -> int:
    """As many processes as this machine has cores for, and memory."""
    from distributed.system import MEMORY_LIMIT

    return max(1, min(_cores() // (chosen_threads() or 1), int(MEMORY_LIMIT) // _MEMORY, _MOST_WORKERS))


def threads_each(at_once: int) -> int:
    """How many threads each of the processes may use, of which so many do a shot at once: they share the cores out."""
    return chosen_threads() or max(1, _cores() // at_once)


def _cores() -> int:
    from dask.system import CPU_COUNT  # which knows the bounds of containers

    return int(CPU_COUNT)


@contextmanager
def local_cluster(workers: int, *, threads: int = 1, cards: int = 0) -> Iterator[Client]:
    """A client of new processes on this machine, each of which does one shot at a time.

    Args:
        workers: how many processes.
        threads: that each may use.
        cards: graphics cards; the first processes have one each.

    Raises:
        OSError: the processes do not start.
    """
    from dask import config
    from distributed import Client, Nanny, Scheduler, SpecCluster

    from .scheduler_plugin import LetsNewWorkersHelp
    from .worker_plugin import KeepsToItself

    require("--workers", workers, 1 <= workers <= _MOST_WORKERS, f"0 to {_MOST_WORKERS}")
    visible = [each for each in os.environ.get(_PER_CARD, "").split(",") if each] or [str(n) for n in range(cards)]
    variables = thread_variables(threads)
    specs: dict[int, Any] = {}
    for number in range(max(workers, cards)):
        options: dict[str, Any] = {
            "nthreads": 1,
            "memory_limit": 0,
            "host": "127.0.0.1",
            "dashboard": False,
            "silence_logs": logging.CRITICAL,
            "plugins": (KeepsToItself(),),
            "env": variables,
        }
        if number < cards:
            options |= {"resources": {GPU: 1}, "env": {**variables, _PER_CARD: visible[number]}}
        specs[number] = {"cls": Nanny, "options": options}
    scheduler = {
        "host": "127.0.0.1",
        "port": 0,
        "dashboard": True,
        "dashboard_address": "127.0.0.1:8787",  # another port where that is taken
        "allowed_failures": MOST_RUNS - 1,
        "plugins": (LetsNewWorkersHelp(),),
    }
    started = {_METHOD: "forkserver" if FORKS else "spawn", _TRIMMED: None, _PROFILED: False}
    with _quiet(), config.set(started), ExitStack() as closing:
        begin_fork_server(__name__)
        with uninterrupted():
            specs_of_scheduler = {"cls": Scheduler, "options": scheduler}
            try:
                made = SpecCluster(workers=specs, scheduler=specs_of_scheduler, silence_logs=logging.CRITICAL)
            except RuntimeError as error:
                raise OSError(f"Dask cannot start processes on this machine: {error}") from error
            closing.callback(_closed, made)
            client = Client(made, set_as_default=False)
            closing.callback(_closed, client)
        yield client


def _closed(what: Any) -> None:
    with uninterrupted():
        what.close()


@contextmanager
def connected(address: str) -> Iterator[Client]:
    """A client of a running cluster.

    Args:
        address: of its scheduler, such as tcp://HOST:8786.

    Raises:
        InvalidInputError: nothing answers there.
    """
    from distributed import Client

    with _quiet():
        try:
            client = Client(address, timeout=_CONNECT_SECONDS, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            told = str(error).partition("\n")[0]
            raise InvalidInputError(
                f"--scheduler must be where a Dask scheduler listens. Got: {address}: {told}"
            ) from None
        with client:
            yield client


@contextmanager
def _quiet() -> Iterator[None]:
    """Without Dask's own messages: what matters of them is said by us."""
    import distributed  # its loggers get their levels with the import

    log = logging.getLogger(distributed.__name__)
    loggers = [
        logging.getLogger(name)
        for name in (*logging.root.manager.loggerDict, log.name)
        if name.split(".")[0] == log.name
    ]
    levels = [each.level for each in loggers]
    for each in loggers:
        each.setLevel(logging.CRITICAL + 1)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", module="distributed")
        warnings.filterwarnings("ignore", message=".*(large graph|dashboard|already in use).*")
        try:
            yield
        finally:
            for each, level in zip(loggers, levels, strict=True):
                each.setLevel(level)
