"""The command that compares methods; it loads the evaluation only when it runs."""

from __future__ import annotations

import argparse
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..evaluation.evaluation_set import EvaluationSet
    from ..evaluation.planning import Plan
    from ..stages import StageProgress

__all__ = ["add_evaluate"]

_LONG = ("svd", "inpainting", "tooncrafter")
"""Stages of a clip that take so long that they have bars of their own."""


def add_evaluate(parser: argparse.ArgumentParser) -> None:
    """All that ``physanimator evaluate`` takes."""
    parser.description = (
        "Draw the pictures of a set by several methods, measure the clips, and report means with intervals as a page,"
        " JSON, CSV and LaTeX. What is there and still made from the same is kept, so that a stopped evaluation goes"
        " on, and a changed set draws only what is new."
    )
    parser.epilog = (
        "REPORT/report.html shows all clips side by side. Methods that lack weights, and columns that do, are left out"
        " with the file that is missing. Nothing is downloaded."
    )
    parser.add_argument(
        "file",
        metavar="SET.toml",
        nargs="?",
        help="pictures, methods, samples and weights; the guide explains it (default: the bundled set of drawings)",
    )
    parser.add_argument("--output", "-o", metavar="REPORT", required=True, help="folder for clips, measures and report")
    parser.add_argument(
        "--method", action="append", default=[], metavar="NAME", help="only this method of the set; may be repeated"
    )
    parser.add_argument(
        "--picture", action="append", default=[], metavar="NAME", help="only this picture of the set; may be repeated"
    )
    parser.add_argument(
        "--figure",
        metavar="ABLATION",
        help="draw an ablation as REPORT/figures/ABLATION.png, its methods included: inpainting, blur, masks, contact,"
        " warp-weight, interpolation",
    )
    parser.add_argument(
        "--trajectories",
        action="append",
        default=[],
        metavar="FORMAT",
        help="write the motion of each clip as another system's input to REPORT/trajectories/, and draw nothing:"
        " drag-anything or motion-i2v; may be repeated",
    )
    parser.add_argument("--processes", type=int, default=1, metavar="N", help="that work at once (default: 1)")
    parser.add_argument("--dry-run", action="store_true", help="check everything, list what would run and what is kept")
    parser.add_argument("--quiet", "-q", action="store_true", help="no progress bars and no report")
    parser.set_defaults(run=_evaluate)


def _evaluate(options: argparse.Namespace) -> None:
    _check_packages()
    from ..evaluation.figures import check_figure, draw_figure
    from ..evaluation.methods import ABLATIONS
    from ..evaluation.planning import planned, restricted
    from ..evaluation.reporting import write_report
    from ..evaluation.results import results_of
    from ..evaluation.running import measure_methods, run
    from .messages import say

    whole, output = _set(options), Path(options.output)
    wanted = options.method or [*ABLATIONS.get(options.figure, ())]
    if options.trajectories:
        return _write_trajectories(options, restricted(whole, wanted, options.picture), output)
    plan = planned(restricted(whole, wanted, options.picture), output)
    if options.figure is not None:
        check_figure(plan, options.figure)
    if options.dry_run:
        return _list(plan)
    with ExitStack() as bars:
        run(plan, processes=options.processes, progress=_progress(options, bars))
    there = planned(whole, output, opened=True).there
    measure_methods(there)
    results = results_of(there)
    if options.figure is not None:
        place = draw_figure(planned(plan.which, output, opened=True).there, results, options.figure)
        if not options.quiet:
            say(f"{place}: drawn")
    write_report(there.folder, results)
    if not options.quiet:
        for sentence in _left_out(there):
            say(sentence)
        say(f"{plan.folder.place / 'report.html'}: {len(there.cells)} clips of {len(there.methods)} methods")
    return None


def _write_trajectories(options: argparse.Namespace, which: EvaluationSet, output: Path) -> None:
    from ...physics.errors import counted, require
    from ..evaluation.motion_inputs import write_trajectories
    from ..evaluation.trajectories import TRAJECTORIES
    from .messages import say

    for name in options.trajectories:
        require("--trajectories", name, name in TRAJECTORIES, f"one of {', '.join(TRAJECTORIES)}")
    with ExitStack() as bars:
        written = write_trajectories(which, output, options.trajectories, progress=_progress(options, bars))
    if not options.quiet:
        say(f"{output / 'trajectories'}: inputs of {counted(written, 'clip')} for {', '.join(options.trajectories)}")


def _check_packages() -> None:
    """Say what to install where the evaluation's own packages are missing."""
    from importlib.util import find_spec

    from ...physics.errors import InvalidInputError

    if find_spec("pydantic") is None:
        raise InvalidInputError("evaluate needs the package pydantic: pip install 'physanimator[evaluate]'. Got: none")


def _set(options: argparse.Namespace) -> EvaluationSet:
    """The set, with the methods of a figure."""
    from dataclasses import replace

    from ...physics.errors import require
    from ..evaluation.methods import ABLATIONS
    from ..evaluation.names import suggestion
    from ..evaluation.set_document import BUNDLED_SET, read_set

    which = read_set(BUNDLED_SET if options.file is None else Path(options.file))
    if options.figure is None:
        return which
    near, known = suggestion(options.figure, ABLATIONS), ", ".join(ABLATIONS)
    require("--figure", repr(options.figure), options.figure in ABLATIONS, f"one of {known}{near}")
    return replace(which, ablations=tuple(dict.fromkeys([*which.ablations, options.figure])))


def _progress(options: argparse.Namespace, stack: ExitStack) -> StageProgress:
    """A bar for all clips, and beneath it those of models, anew for each clip."""
    from ..files import hear_signals
    from .watching import progress_of

    clips = progress_of(options, stack)
    of_clip = stack.enter_context(ExitStack())
    inner: StageProgress = progress_of(options, of_clip)

    def advance(stage: str, done: int, total: int) -> None:
        nonlocal inner
        if stage == "clips":
            of_clip.close()
            inner = progress_of(options, of_clip)
            clips(stage, done, total)
        elif stage in _LONG:
            inner(stage, done, total)
        else:
            hear_signals()

    return advance


def _list(plan: Plan) -> None:
    """What would run, and what is kept."""
    from .messages import show

    for cell in plan.cells:
        state = "kept" if cell.kept and cell.measured else ("measure" if cell.kept else "draw")
        show(f"{state:<9}{cell.name}")
    for sentence in _left_out(plan):
        show(sentence)
    show(f"{len(plan.cells) - len(plan.todo)} of {len(plan.cells)} clips are kept")


def _left_out(plan: Plan) -> list[str]:
    from ..evaluation.planning import left_out

    return [f"left out {who}: {why}" for who, why in left_out(plan.absent)]
