"""A data folder from many videos: by several processes, resumable, and whole whenever it is stopped."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...physics.checks import check_whole
from ...physics.errors import InvalidInputError
from ...physics.progress import Progress
from ..worker_processes import heeding, stopped_at_the_end
from .building import BuildOptions, clips_of, file_names
from .data_folder import ClipRecord
from .data_journal import DataJournal, check_data_folder
from .score_column import ScoredSpan
from .shots import check_cuts_are_found
from .sketching import sketcher_of
from .source_videos import facts_of, identity_of

__all__ = ["BuildWork", "build", "usual_workers"]

_POLL = 0.2  # seconds between two looks at the processes
_ASKED_ALIVE = 64  # frames between two looks at whether the first process still lives
_MOST_WORKERS = 256

_here: dict[str, Any] = {}  # what a worker process keeps between videos


@dataclass(frozen=True)
class BuildWork:
    """What is done with every video.

    Attributes:
        data: the data folder; None writes nothing.
        options: how clips are made.
        lines: weights of a line drawing network.
        device: where it computes.
        licence: for the record.
        scored_by: the index and its column that scores are taken from; empty for our own.
    """

    data: Path | None
    options: BuildOptions
    lines: Path | None = None
    device: str = "auto"
    licence: str = ""
    scored_by: str = ""


def usual_workers() -> int:
    """As many processes as are used unless somebody says otherwise."""
    return max(1, min(8, (os.cpu_count() or 1) - 1))


def build(
    videos: Sequence[Path],
    work: BuildWork,
    *,
    workers: int = 1,
    scores: dict[Path, list[ScoredSpan]] | None = None,
    progress: Progress | None = None,
    heard: Callable[[Path, Sequence[ClipRecord]], None] | None = None,
) -> int:
    """Cut videos into clips, and add those to the data folder; videos that are done already are left out.

    Args:
        videos: see :func:`~physanimator.rendering.training.source_videos.videos_in`.
        work: what is done.
        workers: processes; 1 works in this one.
        scores: of an index, by video.
        progress: called with frames that were read and about how many there are to read; may raise to stop.
        heard: called with each video that is done and its clips.

    Returns:
        How many videos were done already.

    Raises:
        InvalidInputError: the folder is not ours or was made with other options, or a file is unusable.
    """
    check_whole("workers", workers, 1, _MOST_WORKERS)
    check_cuts_are_found()
    journal = DataJournal(work.data) if work.data is not None else None
    name, _ = sketcher_of(work.lines, work.device)  # before any work: it may be no such file
    if journal is not None:
        check_data_folder(journal.data)
        journal.open({**work.options.as_record(), "sketches": name, "scores": work.scored_by})
    known = {identity_of(each): each for each in videos}  # of copies, one
    todo = {identity: each for identity, each in known.items() if journal is None or not journal.is_done(identity)}
    total = sum(_frames(each) for each in todo.values())
    tasks = [
        (identity, video, file_names(video, identity), None if scores is None else scores.get(video, []))
        for identity, video in todo.items()
    ]
    if journal is not None:
        journal.begin([(identity, names, video) for identity, video, names, _ in tasks])
    run = _in_this_process if workers == 1 or len(tasks) <= 1 else _in_processes
    for identity, records in run(tasks, work, workers, lambda done: progress and progress(min(done, total), total)):
        if journal is not None:
            journal.finish(identity, todo[identity], records)
        if heard is not None:
            heard(todo[identity], records)
    if progress is not None and total:
        progress(total, total)
    return len(known) - len(todo)


def _frames(video: Path) -> int:
    try:
        return facts_of(video).frames
    except InvalidInputError:
        return 0


_Task = tuple[str, Path, str, Sequence[ScoredSpan] | None]
_Done = Iterator[tuple[str, list[ClipRecord]]]


def _in_this_process(tasks: Sequence[_Task], work: BuildWork, _: int, advance: Callable[[int], Any]) -> _Done:
    sketcher = sketcher_of(work.lines, work.device)
    read = 0

    def tick() -> None:
        nonlocal read
        read += 1
        advance(read)

    for identity, video, names, scores in tasks:
        yield (
            identity,
            clips_of(
                video,
                names,
                work.options,
                data=work.data,
                sketcher=sketcher,
                scores=scores,
                licence=work.licence,
                tick=tick,
            ),
        )


def _in_processes(tasks: Sequence[_Task], work: BuildWork, workers: int, advance: Callable[[int], Any]) -> _Done:
    context = multiprocessing.get_context("spawn")  # torch and FFmpeg do not survive a fork
    stop, read = context.Event(), context.Value("q", 0)
    pool = ProcessPoolExecutor(min(workers, len(tasks)), context, _begin_worker, (work, stop, read))
    with stopped_at_the_end(pool, stop, called="workers"):
        waiting: dict[Future[list[ClipRecord] | None], str] = {}
        left = iter(tasks)
        while True:
            # No more than the processes need at hand: of a million videos, the rest wait here.
            while len(waiting) < 2 * workers and (task := next(left, None)) is not None:
                waiting[pool.submit(_work, *task[1:])] = task[0]
            if not waiting:
                return
            done, _ = wait(waiting, timeout=_POLL, return_when=FIRST_COMPLETED)
            advance(read.value)
            for each in done:
                records = each.result()
                if records is None:
                    raise KeyboardInterrupt
                yield waiting.pop(each), records


def _begin_worker(work: BuildWork, stop: Any, read: Any) -> None:
    heeding(stop)
    if work.lines is not None:
        import torch

        torch.set_num_threads(1)
    _here.update(work=work, stop=stop, read=read, sketcher=sketcher_of(work.lines, work.device), ticks=0)


def _tick() -> None:
    _here["ticks"] += 1
    parent = multiprocessing.parent_process()
    if _here["stop"].is_set() or (not _here["ticks"] % _ASKED_ALIVE and parent is not None and not parent.is_alive()):
        raise KeyboardInterrupt
    with _here["read"].get_lock():
        _here["read"].value += 1


def _work(video: Path, names: str, scores: Sequence[ScoredSpan] | None) -> list[ClipRecord] | None:
    """The clips of a video; None where the work was stopped."""
    work: BuildWork = _here["work"]
    try:
        return clips_of(
            video,
            names,
            work.options,
            data=work.data,
            sketcher=_here["sketcher"],
            scores=scores,
            licence=work.licence,
            tick=_tick,
        )
    except KeyboardInterrupt:
        return None
