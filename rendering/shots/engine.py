"""Shots on a Dask cluster: as many under way as it has threads, whatever happens to its workers."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ... import __version__
from ...physics.errors import InvalidInputError
from ...physics.kept_memory import keep_memory
from ...physics.threads import chosen_threads, keep_to_threads
from ..files import is_full
from .cluster import GPU
from .job import MOST_RUNS, Job, Outcome, as_now, perform, told_of
from .shipping import Parcel, Returned, packed, perform_elsewhere, unpacked
from .waiting_shots import WaitingShots

if TYPE_CHECKING:
    from distributed import Client, Future

__all__ = ["SchedulerLost", "check_workers", "outcomes_here", "outcomes_of", "workers_for"]

_AHEAD = 2  # shots for each thread that the scheduler knows: none waits for the client, and memory stays bounded

_ANY = ""  # whichever worker

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
    client: Client, jobs: Sequence[Job], *, ship: bool, token: str, heard: Callable[[], None], chosen: bool = False
) -> Iterator[Outcome]:
    """What becomes of each shot, as they end.

    Args:
        client: of the cluster.
        jobs: what to do.
        ship: send files along and bring results back.
        token: unlike that of any other run.
        heard: called now and then; may raise to stop.
        chosen: choose the worker of each shot by the picture that it knows; only in a cluster of our own.

    Raises:
        SchedulerLost: the scheduler is gone; shots that are not told of are not done.
    """
    from distributed import as_completed

    waiting = {on_gpu: WaitingShots(job for job in jobs if job.shot.on_gpu is on_gpu) for on_gpu in (True, False)}
    under_way: dict[Any, tuple[Job, str]] = {}
    completed = as_completed(loop=client.loop, raise_errors=False)
    full = ""
    try:
        while any(waiting.values()) or under_way:
            for on_gpu, queue in waiting.items():
                begun = Counter(worker for job, worker in under_way.values() if job.shot.on_gpu is on_gpu)
                for worker in _places(client, begun, on_gpu=on_gpu, chosen=chosen)[: len(queue)]:
                    heard()
                    job = queue.next_for(worker)
                    try:
                        job, parcel = _packed(job) if ship else (job, None)
                    except OSError as error:
                        yield Outcome(job.shot.name, "failed", told_of(error))
                        continue
                    future = _submitted(client, job, parcel, f"{token}-{job.shot.name}", worker)
                    under_way[future.key] = job, worker
                    completed.add(future)
                    del future
            if not under_way:
                continue
            future = next(completed)
            job, _ = under_way.pop(future.key)
            outcome = _outcome(job, future)
            del future
            yield outcome
            if outcome.full and not full:
                full = f"not begun: {outcome.why}"
                for queue in waiting.values():
                    while queue:
                        yield Outcome(queue.next_for(_ANY).shot.name, "left", full)
    finally:
        if under_way:
            client.cancel(list(completed.futures), force=True)


def _places(client: Client, begun: Counter[str], *, on_gpu: bool, chosen: bool) -> list[str]:
    """The address of a worker for each shot of a kind that the cluster can take now, the idle ones first.

    Args:
        client: of the cluster.
        begun: how many shots of the kind each worker has got.
        on_gpu: the kind.
        chosen: whether we choose the worker, not Dask.

    Raises:
        SchedulerLost: the scheduler does not answer.
    """
    try:
        workers = client.scheduler_info(n_workers=-1)["workers"]
    except OSError:
        raise SchedulerLost(_LOST) from None
    if on_gpu:  # Dask knows which of them have a card
        most = {_ANY: int(sum(each.get("resources", {}).get(GPU, 0) for each in workers.values()))}
    else:
        most = {address: int(each["nthreads"]) for address, each in workers.items()}
        most = most if chosen else {_ANY: sum(most.values())}
    if not sum(most.values()):
        most = {_ANY: 1}
    # What was given to workers that have gone is done by others.
    gone = sum(begun.values()) - sum(begun[each] for each in most)
    free = [
        (begun[worker] + each, number, worker)
        for number, worker in enumerate(most)
        for each in range(most[worker] * _AHEAD - begun[worker])
    ]
    return [worker for _, _, worker in sorted(free)][: max(0, len(free) - gone)]


def _packed(job: Job) -> tuple[Job, Parcel]:
    """A job with what it reads, and known by that; by nothing where it changes meanwhile, so that it is done again."""
    job = as_now(job)
    parcel = packed(job)
    return (job if as_now(job).identity == job.identity else replace(job, identity="")), parcel


def _submitted(client: Client, job: Job, parcel: Parcel | None, key: str, worker: str) -> Future:
    """Have a job done by a worker; by another one where that is gone, or has more to do."""
    where: dict[str, Any] = {"workers": [worker], "allow_other_workers": True} if worker != _ANY else {}
    if job.shot.on_gpu:
        where["resources"] = {GPU: 1}
    if parcel is not None:
        return client.submit(_away, job, parcel, key=key, pure=False, **where)
    return client.submit(_there, job, key=key, pure=False, **where)


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
    """Keep memory, and to the cores that are ours, one unless told; let idle workers draw frames of a long shot."""
    from distributed import get_client, rejoin, secede

    from ..frame_drawing import frames_drawn_by
    from .spreading import LONG, drawing_on_idle_workers

    keep_memory()
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
