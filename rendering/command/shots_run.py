"""The shots of a list done, told one by one, and in the end all together."""

from __future__ import annotations

import argparse
import os
import secrets
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING

from .failures import FAILED

if TYPE_CHECKING:
    from ..shots import Job, Outcome, Shot

__all__ = ["run_shots"]

_SHOWN = 12  # number of the frame that a contact sheet shows, or the last
_WIDE = 320  # width of it [px]


def run_shots(options: argparse.Namespace, shots: Sequence[Shot], kept: Sequence[Outcome], jobs: Sequence[Job]) -> None:
    """Do what is to do; say, and write down, what became of all.

    Args:
        options: of the command; gets the exit status.
        shots: that are asked for.
        kept: what is known of those that are done already.
        jobs: what to do of the others.

    Raises:
        InvalidInputError: the work cannot be done there.
        SchedulerLost: the scheduler is gone.
    """
    from ..shots import alone_in, forgetting, outcomes_here

    found = {each.name: each for each in kept}
    told = _Teller(options, len(shots), len(kept))
    with ExitStack() as stack:
        if options.workers != 0:
            stack.enter_context(alone_in(options.output))
        stack.enter_context(forgetting(options.output, [job.shot for job in jobs]))
        stack.callback(_end, options, shots, found)
        if not jobs:
            return

        def left(on_gpu: bool) -> int:
            return sum(job.shot.on_gpu is on_gpu and job.shot.name not in found for job in jobs)

        outcomes = outcomes_here(jobs, _heard) if options.workers == 0 else _on_cluster(options, jobs, left, stack)
        for outcome in outcomes:
            found[outcome.name] = outcome
            told(outcome)


def _on_cluster(
    options: argparse.Namespace, jobs: Sequence[Job], left: Callable[[bool], int], stack: ExitStack
) -> Iterator[Outcome]:
    """The outcomes of jobs, of which so many are left, with networks or without."""
    from ...physics.errors import counted
    from ...physics.threads import chosen_threads
    from ..shots import (
        check_workers,
        connected,
        local_cluster,
        longest_first,
        missing_workers_told,
        outcomes_of,
        threads_each,
        usual_workers,
        workers_for,
    )
    from .messages import say, warn

    if options.scheduler is not None:
        client = stack.enter_context(connected(options.scheduler))
    else:
        cards = _cards(jobs)
        if not cards:
            jobs = [replace(job, shot=replace(job.shot, on_gpu=False)) for job in jobs]
        workers = usual_workers() if options.workers is None else options.workers
        each = threads_each(min(workers, len(jobs))) if options.workers is None else chosen_threads() or 1
        begun = local_cluster(workers_for(jobs, workers), threads=each, cards=min(cards, len(jobs)))
        client = stack.enter_context(begun)
    if not options.quiet and "dashboard" in client.scheduler_info().get("services", {}):
        say(f"dashboard: {client.dashboard_link}")
    if not options.quiet:
        say(f"{counted(len(jobs), 'shot')} to do, {_when(sum(client.nthreads().values()), jobs)}")
    check_workers(client, jobs, ship=options.ship)
    if options.scheduler is not None:
        stack.enter_context(missing_workers_told(client, left, warn))
    ours, token = options.scheduler is None, secrets.token_hex(4)
    return outcomes_of(client, longest_first(jobs), ship=options.ship, token=token, heard=_heard, chosen=ours)


def _when(at_once: int, jobs: Sequence[Job]) -> str:
    """How many shots are done at once, or for what they wait."""
    from ..shots import GPU_WORKERS

    if at_once:
        return f"{at_once} at once"
    when = "once a worker has come to the scheduler"
    if any(job.shot.on_gpu for job in jobs):
        when += f"; those with networks wait for {GPU_WORKERS}"
    return when


def _cards(jobs: Sequence[Job]) -> int:
    """Graphics cards of this machine, where shots ask for them."""
    if not any(job.shot.on_gpu for job in jobs):
        return 0
    import torch

    return int(torch.cuda.device_count())


def _heard() -> None:
    from ..files import hear_signals

    hear_signals()


class _Teller:
    """Says of each shot that it has ended."""

    def __init__(self, options: argparse.Namespace, count: int, done: int) -> None:
        self._options, self._count, self._ended = options, count, done

    def __call__(self, outcome: Outcome) -> None:
        from .messages import say, warn

        self._ended += 1
        head = f"[{self._ended}/{self._count}] {outcome.name}"
        if not outcome.is_good:
            warn(f"{head}: {outcome.state}: {outcome.why}")
        elif not self._options.quiet:
            say(f"{head}: {outcome.state} in {outcome.seconds:.1f} s on {outcome.machine}")
        if not self._options.quiet:
            for line in outcome.said:
                warn(f"{outcome.name}: {line}")


def _end(options: argparse.Namespace, shots: Sequence[Shot], found: dict[str, Outcome]) -> None:
    """The table and the report of what became of all shots, however the run has ended."""
    from ...physics.errors import counted
    from ..shots import Outcome, summary_lines, write_report
    from .messages import say, warn

    ended = [found.get(shot.name, Outcome(shot.name, "left", "not begun, or not ended")) for shot in shots]
    bad = [each for each in ended if not each.is_good]
    options.status = FAILED if bad else 0
    for line in summary_lines(bad):
        warn(line)
    if not options.quiet:
        done = sum(each.state == "done" for each in ended)
        kept = sum(each.state == "kept" for each in ended)
        say(f"{counted(len(shots), 'shot')}: {done} done now, {kept} done before, {len(bad)} not done")
    if options.report is not None:
        known = list(zip(shots, ended, strict=True))
        write_report(options.report, known, title=os.path.basename(options.list), picture_of=_picture_of)


def _picture_of(clip: str) -> str:
    """A small picture of a clip, from half a second on, as an address that holds it."""
    from ...physics.errors import InvalidInputError
    from ..pictures import data_address, over, read_clip, resized

    frame = None
    try:
        for frame in islice(read_clip(clip), _SHOWN + 1):  # noqa: B007
            pass
    except (InvalidInputError, OSError):  # such as layers as sequences
        pass
    if frame is None:
        return ""
    height = max(1, round(frame.shape[0] * _WIDE / frame.shape[1]))
    return data_address(resized(over(frame), _WIDE, height))
