"""The command about many shots: ``physanimator shots``."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from itertools import repeat
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..shots import Job, Outcome, Problem, Shot

__all__ = ["BESIDES", "add_shots"]

BESIDES = ("report", "write_commands", "write_openjd")  # options of files that are written besides clips


def add_shots(parser: argparse.ArgumentParser) -> None:
    """All that ``physanimator shots`` takes."""
    parser.description = (
        "Animate every shot of a list, on all cores or on a cluster of machines. All are checked before one begins. A"
        " second run does only what is missing or has changed. Exit status: 0 all are there, 1 some are not, 2 the list"
        " or an option is wrong and nothing was begun."
    )
    parser.add_argument(
        "list",
        metavar="SHOTS",
        help="TOML with [defaults] and a [[shot]] for each, whose keys are name and the options of animate, such as"
        " image, mask, wind-angle = 30, contact = true; or CSV with a row for each below the names of options, several"
        " values of a cell with | between them. Paths are from the list's folder on; {name} and {out} in those of"
        " results stand for the shot's name and --output",
    )
    parser.add_argument(
        "--output", "-o", metavar="OUT", required=True, help="folder of OUT/NAME.mp4; made where it is missing"
    )
    parser.add_argument("--only", metavar="NAME", action="extend", nargs="+", help="do these shots of the list")
    parser.add_argument("--dry-run", action="store_true", help="check everything and say what would be done")
    where = parser.add_argument_group("where the work is done")
    where.add_argument(
        "--workers",
        metavar="N",
        type=int,
        help="processes on this machine, of one thread each (default: one a core, as memory allows; fewer shots than"
        " that share the cores out); 0: in this one, without Dask",
    )
    where.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="use a running Dask cluster, such as tcp://HOST:8786; its machines have PhysAnimator and see the files"
        " under the same paths, or --ship is given",
    )
    where.add_argument(
        "--ship",
        action="store_true",
        help="send pictures to the cluster's machines and results back through the scheduler; weights of networks must"
        " be there under the same paths",
    )
    more = parser.add_argument_group("what else is written")
    more.add_argument("--report", metavar="OUT.html", help="contact sheet of all shots")
    more.add_argument(
        "--write-commands", metavar="OUT", help="do nothing but write one shell line a shot, for farms and GNU parallel"
    )
    more.add_argument(
        "--write-openjd",
        metavar="OUT.yaml",
        help="do nothing but write an Open Job Description template with one task a shot",
    )
    parser.add_argument("--quiet", "-q", action="store_true", help="say only what went wrong")
    parser.set_defaults(run=_shots)


def _shots(options: argparse.Namespace) -> None:
    from ..shots import begin_fork_server, check_installed, others_files
    from .shots_run import run_shots

    _check_options(options)
    for_farms = options.write_commands or options.write_openjd
    in_processes = not (options.workers == 0 or options.dry_run or for_farms)
    if in_processes:
        check_installed()
    with _output_folder(options):
        shots, problems = _chosen(options)
        kept, jobs = _what_to_do(options, shots)
        if in_processes and options.scheduler is None and jobs:
            begin_fork_server(f"{__package__}.shot_imports")  # it imports while the shots are checked
        to_do = shots if for_farms else [each.shot for each in jobs]
        moving: dict[str, int] = {}
        lists = os.path.dirname(options.list)
        _refuse(options, [*problems, *others_files(options.output, to_do, lists=lists), *_wrong(to_do, moving)])
        if for_farms:
            _write_for_farms(options, shots)
        elif options.dry_run:
            _tell_plan(options, shots, jobs)
        else:
            known = [replace(job, shot=replace(job.shot, moving=moving.get(job.shot.name, 0))) for job in jobs]
            run_shots(options, shots, kept, known)


def _check_options(options: argparse.Namespace) -> None:
    from ...physics.errors import InvalidInputError, require
    from ..files import check_file_place, check_text_output
    from .names import named_as

    if options.scheduler is not None and options.workers is not None:
        raise InvalidInputError("--workers and --scheduler say in two ways where the work is done. Got: both")
    if options.ship and options.scheduler is None:
        raise InvalidInputError("--ship needs --scheduler, to whose machines the files are sent. Got: without")
    if options.workers is not None:
        require("--workers", options.workers, 0 <= options.workers <= 1024, "0 to 1024")
    for name, suffix in (("report", ".html"), ("write_openjd", ".yaml"), ("write_commands", None)):
        given = getattr(options, name)
        if given is not None:
            with named_as(f"--{name.replace('_', '-')}", "output", "the name"):
                check_file_place(given) if suffix is None else check_text_output(given, suffix)


@contextmanager
def _output_folder(options: argparse.Namespace) -> Iterator[None]:
    """The folder of results, which goes again where nothing came into it."""
    from ..files import check_folder_place
    from .names import named_as

    with named_as("--output", "output"):
        place = check_folder_place(options.output)
    made = not place.is_dir()
    if made:
        place.mkdir()
    try:
        yield
    finally:
        if made:
            with suppress(OSError):
                place.rmdir()


def _chosen(options: argparse.Namespace) -> tuple[list[Shot], list[Problem]]:
    """The shots of the list that are asked for, and what is wrong with the list.

    Raises:
        InvalidInputError: the list cannot be read, or has none of a name.
    """
    from ...physics.errors import InvalidInputError
    from .shot_list import read_list

    besides = [(f"--{name.replace('_', '-')}", getattr(options, name)) for name in BESIDES]
    read = read_list(options.list, options.output, also_written=[each for each in besides if each[1] is not None])
    if options.only is None:
        return list(read.shots), list(read.problems)
    known = {shot.name: shot for shot in read.shots}
    wrong = {each.shot for each in read.problems}
    for name in options.only:
        if name not in {*known, *wrong}:
            raise InvalidInputError(f"--only must name shots of the list. Got: {name}")
    problems = [each for each in read.problems if each.shot in ("", *options.only)]
    return [known[name] for name in dict.fromkeys(options.only) if name in known], problems


def _refuse(options: argparse.Namespace, problems: Sequence[Problem]) -> None:
    """
    Raises:
        InvalidInputError: there are problems; each has been told.
    """
    from ...physics.errors import InvalidInputError, counted
    from ..shots import merged
    from .messages import warn

    if not problems:
        return
    told = merged(problems)
    for each in told:
        warn(f"{options.list}: {each}")
    raise InvalidInputError(f"{options.list} has {counted(len(told), 'error')}; nothing was begun")


def _wrong(shots: Sequence[Shot], moving: dict[str, int]) -> Iterator[Problem]:
    """All that ``animate`` would refuse of shots; ``moving`` gets how many pixels of each move."""
    from ...physics.beside import side_by_side
    from .shot_list import check_shot

    for found in side_by_side(check_shot, shots, repeat(moving, len(shots))):
        yield from found


def _what_to_do(options: argparse.Namespace, shots: Sequence[Shot]) -> tuple[list[Outcome], list[Job]]:
    """Shots that are done already, and what to do of the others."""
    from ..shots import NOTES, FileDigests, Job, Outcome, identity_of, is_finished
    from .shot_task import animate_shot, shot_files

    digests, notes = FileDigests(), os.path.join(os.path.abspath(options.output), NOTES)
    kept, jobs = [], []
    for shot in shots:
        try:
            identity = identity_of(shot, digests)
        except OSError:  # told by the checks
            identity = ""
        record = is_finished(shot, identity)
        if record is None:
            jobs.append(Job(shot, identity, animate_shot, shot_files, notes))
        else:
            kept.append(Outcome(shot.name, "kept", "", record.seconds, record.machine, record.said))
    return kept, jobs


def _write_for_farms(options: argparse.Namespace, shots: Sequence[Shot]) -> None:
    from ...physics.errors import counted
    from ..files import write_text
    from ..shots import command_lines, openjd_template
    from .messages import say

    lines, template = options.write_commands, options.write_openjd
    if lines is not None:
        write_text(lines, command_lines(shots, listed=options.list, out=options.output))
    if template is not None:
        write_text(template, openjd_template(shots, listed=options.list, out=options.output, template=template))
    if not options.quiet:
        for path in filter(None, (lines, template)):
            say(f"{path}: {counted(len(shots), 'shot')}")


def _tell_plan(options: argparse.Namespace, shots: Sequence[Shot], jobs: Sequence[Job]) -> None:
    from ...physics.errors import counted
    from ..shots import read_shot_record
    from .messages import show

    identities = {job.shot.name: job.identity for job in jobs}
    for shot in shots:
        record = read_shot_record(shot.record)
        if shot.name not in identities:
            state = "is done"
        elif record is None:
            state = "to do"
        else:
            state = "to do again: " + (
                "what it wrote was changed"
                if record.identity == identities[shot.name]
                else "what it reads, its options or PhysAnimator changed"
            )
        show(f"{shot.name}: {state}; {', '.join(word.text or '' for word in shot.paths('output'))}")
    show(f"{counted(len(jobs), 'shot')} to do, {len(shots) - len(jobs)} done")
