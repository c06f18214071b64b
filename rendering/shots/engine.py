"""Shots on a Dask cluster: as many under way as it has threads, whatever happens to its workers."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ... import __version__
from ...physics.errors import InvalidInputError
from ...physics.threads import chosen_threads, keep_to_threads
from ..files import is_full
from .cluster import GPU
from .job import MOST_RUNS, Job, Outcome, as_now, perform, told_of
from .shipping import Parcel, Returned, packed, perform_elsewhere, unpacked

if TYPE_CHECKING:
    from distributed import Client, Future

__all__ = ["SchedulerLost", "check_workers", "outcomes_here", "outcomes_of", "workers_for"]

_AHEAD = 2  # shots for each thread that the scheduler knows: none waits for the client, and memory stays bounded

_LOST = "the scheduler is gone; finished shots are whole, and the same command does the others"


class SchedulerLost(OSError):
    """The scheduler is gone."""


def outcomes_here(jobs: Sequence[Job], heard: Callable[[], None]) -> Iterator[Outcome]:
    """What becomes of each shot, one after the other in this process."""
    full = ""
    for job in jobs:
        heard()
        if full:
            yield Outcome(job.shot.name, "left", full)
            continue
        outcome = perform(job, waits=True)
        full = f"not begun: {outcome.why}" if outcome.full else ""
        yield outcome


def check_workers(client: Client, jobs: Sequence[Job], *, ship: bool) -> None:
    """Refuse a cluster whose workers could not do the shots; those that come later are not asked.

    Raises:
        InvalidInputError: the message names a worker, and what it lacks.
    """
    asking = [job.shot.name for job in jobs if job.shot.on_gpu]
    workers = client.scheduler_info(n_workers=-1)["workers"].values()
    if asking and workers and not any(each.get("resources", {}).get(GPU) for each in workers):
        raise InvalidInputError(
            "shots with networks need a worker with a graphics card, dask worker --resources 'GPU=1', or device ="
            f' "cpu". Got: {asking[0]}, and {len(workers)} workers without'
        )
    folder = os.path.dirname(jobs[0].notes)
    for address, answer in client.run(_introduced, folder, on_error="return").items():
        version, sees = answer if isinstance(answer, tuple) else (f"none: {answer}", True)
        if version != __version__:
            raise InvalidInputError(f"workers must have PhysAnimator {__version__}. Got: {version} at {address}")
        if not (sees or ship):
            raise InvalidInputError(f"workers must see {folder}, or --ship be given. Got: no such folder at {address}")


def _introduced(folder: str) -> tuple[str, bool]:
    """On a worker: its version, and whether it sees a folder."""
    return __version__, os.path.isdir(folder)


def workers_for(jobs: Sequence[Job], most: int) -> int:
    """How many of the workers that there may be have something to do: all where a shot is long, which they share."""
    from .spreading import LONG

    return most if any(job.shot.frames >= LONG for job in jobs) else min(most, len(jobs))


def outcomes_of(
    client: Client, jobs: Sequence[Job], *, ship: bool, token: str, heard: Callable[[], None]
) -> Iterator[Outcome]:
    """What becomes of each shot, as they end.

    Args:
        client: of the cluster.
        jobs: what to do.
        ship: send files along and bring results back.
        token: unlike that of any other run.
        heard: called now and then; may raise to stop.

    Raises:
        SchedulerLost: the scheduler is gone; shots that are not told of are not done.
    """
    from distributed import as_completed

    waiting = {on_gpu: deque(job for job in jobs if job.shot.on_gpu is on_gpu) for on_gpu in (True, False)}
    under_way: dict[Any, Job] = {}
    completed = as_completed(loop=client.loop, raise_errors=False)
    full = ""
    try:
        while any(waiting.values()) or under_way:
            for on_gpu, queue in waiting.items():
                begun = sum(job.shot.on_gpu is on_gpu for job in under_way.values())
                for _ in range(min(len(queue), _places(client, on_gpu=on_gpu) * _AHEAD - begun)):
                    heard()
                    job = queue.popleft()
                    try:
                        job, parcel = _packed(job) if ship else (job, None)
                    except OSError as error:
                        yield Outcome(job.shot.name, "failed", told_of(error))
                        continue
                    future = _submitted(client, job, parcel, f"{token}-{job.shot.name}")
                    under_way[future.key] = job
                    completed.add(future)
                    del future
            if not under_way:
                continue
            future = next(completed)
            job = under_way.pop(future.key)
            outcome = _outcome(job, future)
            del future
            yield outcome
            if outcome.full and not full:
                full = f"not begun: {outcome.why}"
                for queue in waiting.values():
                    while queue:
                        yield Outcome(queue.popleft().shot.name, "left", full)
    finally:
        if under_way:
            client.cancel(list(completed.futures), force=True)


def _places(client: Client, *, on_gpu: bool) -> int:
    """How many shots of a kind the cluster can do at once, now.

    Raises:
        SchedulerLost: the scheduler does not answer.
    """
    try:
        workers = client.scheduler_info(n_workers=-1)["workers"].values()
    except OSError:
        raise SchedulerLost(_LOST) from None
    if on_gpu:
        return max(1, int(sum(each.get("resources", {}).get(GPU, 0) for each in workers)))
    return max(1, sum(int(each["nthreads"]) for each in workers))


def _packed(job: Job) -> tuple[Job, Parcel]:
    """A job with what it reads, and known by that; by nothing where it changes meanwhile, so that it is done again."""
    job = as_now(job)
    parcel = packed(job)
    return (job if as_now(job).identity == job.identity else replace(job, identity="")), parcel


def _submitted(client: Client, job: Job, parcel: Parcel | None, key: str) -> Future:
    resources = {GPU: 1} if job.shot.on_gpu else None
    if parcel is not None:
        return client.submit(_away, job, parcel, key=key, resources=resources, pure=False)
    return client.submit(_there, job, key=key, resources=resources, pure=False)


def _outcome(job: Job, future: Future) -> Outcome:
    from distributed import KilledWorker

    name = job.shot.name
    if future.status == "finished":
        result = future.result()
        if isinstance(result, Outcome):
            return result
        try:
            return unpacked(job, result)
        except (OSError, InvalidInputError) as error:
            return Outcome(name, "failed", told_of(error), full=is_full(error))
    if future.status == "error":
        raised = future.exception()
        if isinstance(raised, KilledWorker):
            return Outcome(name, "lost", f"its worker was killed {MOST_RUNS} times")
        return Outcome(name, "failed", f"{type(raised).__name__}: {raised}")
    raise SchedulerLost(_LOST)


def _there(job: Job) -> Outcome:
    """On a worker: a shot whose files it sees."""
    with _as_a_worker(job):
        return perform(job, _wanted())


def _away(job: Job, parcel: Parcel) -> Returned:
    """On a worker: a shot whose files have come along."""
    from distributed import get_worker

    with _as_a_worker(job):
        return perform_elsewhere(job, parcel, _wanted(), folder=get_worker().local_directory)


@contextmanager
def _as_a_worker(job: Job) -> Iterator[None]:
    """Keep to the cores that are this worker's, one unless it is told; let idle ones draw frames of a long shot."""
    from distributed import get_client, rejoin, secede

    from ..frame_drawing import frames_drawn_by
    from .spreading import LONG, drawing_on_idle_workers

    keep_to_threads(chosen_threads() or 1)
    if job.shot.frames < LONG:
        yield
        return
    with frames_drawn_by(drawing_on_idle_workers(get_client(), secede, rejoin)):
        yield


def _wanted() -> Callable[[], bool]:
    """Asks whether the scheduler still wants what this thread works on."""
    from distributed import get_worker

    worker: Any = get_worker()
    key = worker.get_current_task()

    def wanted() -> bool:
        task = worker.state.tasks.get(key)
        return task is not None and task.state in ("executing", "long-running")

    return wanted
