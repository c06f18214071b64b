"""What is missing is drawn and measured, by one process or several; whatever is done stays done."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from typing import Any

from ...physics.checks import check_whole
from ...physics.errors import InvalidInputError
from ..stages import StageProgress
from ..worker_processes import heeding, stopped_at_the_end
from .clip_files import KeptClip, kept_clip, remove_unfinished_clips, write_clip
from .columns import COLUMNS, ClipOfPicture, Column, method_values
from .drawing import drawn_frames
from .foreign_clips import foreign_clip, foreign_rate
from .identity import clip_recipe, digest_of_recipe
from .measuring import as_json, clip_of, measured_clip
from .motions import Impossible, reference_of
from .planning import IMPOSSIBLE, Cell, Plan, column_weights

__all__ = ["measure_methods", "run"]

_POLL = 0.2  # seconds between two looks at the processes
_MOST_PROCESSES = 256

_here: dict[str, Any] = {}  # what a worker process keeps between clips


def run(
    plan: Plan,
    *,
    processes: int = 1,
    progress: StageProgress | None = None,
    done: Callable[[Cell], None] | None = None,
) -> None:
    """Draw and measure what is missing.

    Args:
        plan: see :func:`~.planning.planned`.
        processes: how many work at once; 1 works in this one.
        progress: called with the stage "clips" and how many are done and wanted, and in this process with the stages
            of each; may raise to stop.
        done: called with each clip that is done.

    Raises:
        InvalidInputError: a clip cannot be made; the message names it.
    """
    check_whole("processes", processes, 1, _MOST_PROCESSES)
    plan.folder.open()
    remove_unfinished_clips(plan.folder.clips)
    todo = plan.todo
    count = min(processes, len(_groups(todo)))
    later = _by_networks(plan) if count > 1 else ()
    if progress is not None and todo:
        progress("clips", 0, len(todo))
    made = _in_this_process(todo, plan, progress) if count <= 1 else _in_processes(todo, plan, count, progress)
    for finished, cell in enumerate(made, start=1):
        if done is not None:
            done(cell)
        if progress is not None:
            progress("clips", finished, len(todo))
    for cell in todo if later else ():
        _complete(cell, plan, later, progress)


def _by_networks(plan: Plan) -> tuple[Column, ...]:
    """Columns whose networks are at hand: so large that only one process may hold them."""
    weights = column_weights(plan.which)
    return tuple(each for each in COLUMNS if each.weights and any(weights.place(key) for key in each.weights))


def _complete(cell: Cell, plan: Plan, later: Sequence[Column], progress: StageProgress | None) -> None:
    """Add what networks measure to what another process has measured of a clip."""
    which, folder, method = plan.which, plan.folder, cell.method
    file = folder.measures(method.name, cell.picture.name, cell.sample)
    values = folder.read_measures(file, _partial_key(cell, plan))
    kept = kept_clip(folder.clip(method.name, cell.picture.name, cell.sample), cell.key)
    if values is None or kept is None:
        return
    advance = None if progress is None else lambda done, total: progress("measure", done, total)
    more = measured_clip(
        which, cell.picture, cell.sample, method, kept, column_weights(which), columns=later, progress=advance
    )
    folder.write_measures(file, _key(cell, plan), values | more)


def _key(cell: Cell, plan: Plan) -> str:
    return f"{cell.key} {plan.weights_key}"


def _partial_key(cell: Cell, plan: Plan) -> str:
    return f"{_key(cell, plan)} without networks"


def _groups(cells: Sequence[Cell]) -> list[list[Cell]]:
    """Clips of one sample stay together, as they share its motion."""
    found: dict[tuple[str, int], list[Cell]] = {}
    for cell in cells:
        found.setdefault((cell.picture.name, cell.sample), []).append(cell)
    return list(found.values())


def _make(cell: Cell, plan: Plan, progress: StageProgress | None, *, later: Sequence[Column] = ()) -> None:
    """Draw a clip if it is missing, and measure it, but for columns that come later."""
    which, folder = plan.which, plan.folder
    columns = [each for each in COLUMNS if each not in later]
    key = _partial_key(cell, plan) if later else _key(cell, plan)
    place = folder.clip(cell.method.name, cell.picture.name, cell.sample)
    try:
        kept = kept_clip(place, cell.key) or _drawn(cell, plan, progress)
        advance = None if progress is None else lambda done, total: progress("measure", done, total)
        weights = column_weights(which)
        values = measured_clip(
            which, cell.picture, cell.sample, cell.method, kept, weights, columns=columns, progress=advance
        )
    except Impossible as error:
        key, values = _key(cell, plan), {IMPOSSIBLE: str(error)}
    except InvalidInputError as error:
        raise InvalidInputError(f"{cell.name}: {error}") from error
    file = folder.measures(cell.method.name, cell.picture.name, cell.sample)
    folder.write_measures(file, key, values)


def _drawn(cell: Cell, plan: Plan, progress: StageProgress | None) -> KeptClip:
    which, place = plan.which, plan.folder.clip(cell.method.name, cell.picture.name, cell.sample)
    place.parent.mkdir(parents=True, exist_ok=True)
    recipe = clip_recipe(which, cell.picture, cell.sample, cell.method)
    if cell.method.clips:
        rate = foreign_rate(which, cell.method, foreign_clip(cell.method, cell.picture, cell.sample))
    else:
        rate = reference_of(which, cell.picture, cell.sample, contact=cell.method.contact).motion.frame_rate
    write_clip(place, _unchanged(cell, plan, progress), rate, cell.key, recipe)
    kept = kept_clip(place, cell.key)
    if kept is None:
        raise InvalidInputError(f"{place} must stay as it was written. Got: another content")
    return kept


def _unchanged(cell: Cell, plan: Plan, progress: StageProgress | None) -> Iterator[Any]:
    """The frames, unless a file that they are made from was changed meanwhile."""
    facts = plan.which, cell.picture, cell.sample, cell.method
    yield from drawn_frames(*facts, progress=progress)
    if digest_of_recipe(clip_recipe(*facts)) != cell.key:
        raise InvalidInputError("files must stay as they are while they are drawn. Got: one that was changed")


def measure_methods(plan: Plan) -> None:
    """Measure what all clips of a method have together, where that is not known.

    Args:
        plan: whose clips are there.
    """
    weights = column_weights(plan.which)
    columns = [each for each in COLUMNS if each.of == "method"]
    for method in plan.methods:
        cells, key = plan.cells_of(method), plan.method_key(method)
        file = plan.folder.method_measures(method.name)
        if plan.folder.read_measures(file, key) is not None:
            continue
        clips = _Clips(plan, cells)
        found = method_values(clips, columns, weights)
        plan.folder.write_measures(file, key, {name: _summary(value) for name, value in found.items()})


def _summary(value: Any) -> Any:
    if value is None or not hasattr(value, "mean"):
        return as_json(value)
    return {"mean": value.mean, "low": value.low, "high": value.high, "count": value.count}


class _Clips(Collection[ClipOfPicture]):
    """The clips of a method, read one after another, as often as they are asked for."""

    def __init__(self, plan: Plan, cells: Sequence[Cell]) -> None:
        self._plan, self._cells = plan, cells

    def __len__(self) -> int:
        return len(self._cells)

    def __contains__(self, clip: object) -> bool:
        return any(clip is each for each in self)

    def __iter__(self) -> Iterator[ClipOfPicture]:
        for cell in self._cells:
            place = self._plan.folder.clip(cell.method.name, cell.picture.name, cell.sample)
            kept = kept_clip(place, cell.key)
            if kept is None:
                raise InvalidInputError(f"{place} must stay as it was written. Got: another content")
            yield clip_of(self._plan.which, cell.picture, cell.sample, cell.method, kept)


def _in_this_process(cells: Sequence[Cell], plan: Plan, progress: StageProgress | None) -> Iterator[Cell]:
    for cell in cells:
        _make(cell, plan, progress)
        yield cell


def _in_processes(cells: Sequence[Cell], plan: Plan, processes: int, progress: StageProgress | None) -> Iterator[Cell]:
    context = multiprocessing.get_context("spawn")  # torch, Taichi and FFmpeg do not survive a fork
    stop, finished = context.Event(), context.Queue()
    pool = ProcessPoolExecutor(processes, context, _begin_worker, (plan, stop, finished))
    by_name = {cell.name: cell for cell in cells}
    heard = 0
    with stopped_at_the_end(pool, stop, called="processes"):
        waiting: set[Future[None]] = {pool.submit(_work, group) for group in _groups(cells)}
        while waiting:
            done, waiting = wait(waiting, timeout=_POLL, return_when=FIRST_COMPLETED)
            for each in done:
                each.result()
            while not finished.empty():
                heard += 1
                yield by_name[finished.get()]
            if progress is not None:
                progress("clips", heard, len(cells))
        while heard < len(cells):
            heard += 1
            yield by_name[finished.get(timeout=60)]


def _begin_worker(plan: Plan, stop: Any, finished: Any) -> None:
    heeding(stop)
    _here.update(plan=plan, stop=stop, finished=finished, later=_by_networks(plan))


def _heard(*_: Any) -> None:
    parent = multiprocessing.parent_process()
    if _here["stop"].is_set() or (parent is not None and not parent.is_alive()):
        raise KeyboardInterrupt


def _work(cells: Sequence[Cell]) -> None:
    """Clips of one sample, one after another, until the work is stopped."""
    try:
        for cell in cells:
            _heard()
            _make(cell, _here["plan"], _heard, later=_here["later"])
            _here["finished"].put(cell.name)
    except KeyboardInterrupt:
        return
