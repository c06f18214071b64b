"""The commands about studies with people; they load what they need only when they run."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..evaluation.study import StudyResults

__all__ = ["add_study"]


def add_study(parser: argparse.ArgumentParser) -> None:
    """All that ``physanimator study`` takes."""
    parser.description = "Ask people which of two clips they prefer, as the paper's user study does, and count."
    commands = parser.add_subparsers(required=True, metavar="WHAT", parser_class=type(parser))
    for name, add, run, summary in (
        ("make", _add_make, _make, "write a page on which raters choose between clips"),
        ("results", _add_results, _results, "count the answers that raters saved"),
    ):
        command = commands.add_parser(name, help=summary, allow_abbrev=False)
        add(command)
        command.set_defaults(run=run)


def _add_make(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Write one page, with the clips in it, on which raters see two clips of the same picture in step and choose."
        " It works offline and sends nothing; answers are saved as a file. Which clip is of which method stands only in"
        " PAGE.key.json beside the page, which raters do not get."
    )
    parser.add_argument(
        "clips",
        metavar="CLIPS",
        nargs="+",
        help="folders, one a method, with clips of the same names (videos, or folders of pictures); NAME=FOLDER names"
        " the method, or else the folder does",
    )
    parser.add_argument("--output", "-o", metavar="PAGE.html", required=True, help="page to write")
    parser.add_argument(
        "--against", metavar="NAME", help="the method that each other one is shown with (default: every two methods)"
    )
    parser.add_argument(
        "--questions",
        default="vq,tc,mp,overall",
        metavar="KEY,KEY",
        help="about each pair: vq visual quality, tc temporal consistency, mp motion plausibility, overall, anime"
        ' ("Which video resembles real anime more?"); empty for none of them (default: %(default)s)',
    )
    parser.add_argument(
        "--question", action="append", default=[], metavar="TEXT", help="one more in your own words; may be repeated"
    )
    parser.add_argument("--language", default="en", help="of the page: en, ja, zh or ko (default: %(default)s)")
    parser.add_argument("--title", default="", metavar="TEXT", help="above the page (default: the language's)")
    trials = parser.add_argument_group("what is shown")
    trials.add_argument("--pairs", type=int, metavar="N", help="at most, as many of each two methods (default: all)")
    trials.add_argument(
        "--catch",
        type=int,
        metavar="N",
        help="pairs of which one clip is broken, to find careless raters (default: one for eight pairs, at least two)",
    )
    trials.add_argument(
        "--practice",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="begin with a pair that does not count (default: yes)",
    )
    trials.add_argument("--seed", type=int, default=0, help="of order and sides (default: %(default)s)")
    files = parser.add_argument_group("clips")
    files.add_argument(
        "--width", type=int, default=720, metavar="PX", help="longest side; larger ones shrink (default: %(default)s)"
    )
    files.add_argument(
        "--fps", type=float, default=24.0, help="of clips that do not say, such as folders (default: %(default)s)"
    )
    files.add_argument(
        "--beside", action="store_true", help="put the clips into PAGE_clips/ beside the page, for many or long ones"
    )
    files.add_argument(
        "--limit", type=float, default=100.0, metavar="MB", help="largest page with clips in it (default: %(default)g)"
    )
    parser.add_argument("--quiet", "-q", action="store_true", help="no progress bars and no report")


def _add_results(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Count answers: how often a method is preferred, with 95 % intervals (Clopper and Pearson), and how far raters"
        " agree (Krippendorff's alpha: 1 all, 0 as by chance). Raters who miss catch trials are left out; of several"
        " files of one rater the last answers count."
    )
    parser.add_argument(
        "answers", metavar="ANSWERS.json", nargs="+", help="files that raters saved; the key may be one"
    )
    parser.add_argument(
        "--key", metavar="PAGE.key.json", help="of the study (default: found beside the answers or a folder above)"
    )
    parser.add_argument("--against", metavar="NAME", help="method that stands first (default: the one in all pairs)")
    parser.add_argument(
        "--least-caught",
        type=float,
        default=0.8,
        metavar="SHARE",
        help="of catch answers that must be right, or the rater is dropped; 0 keeps all (default: %(default)s)",
    )
    parser.add_argument("--json", action="store_true", help="print all numbers as JSON")
    parser.add_argument("--csv", metavar="OUT.csv", help="write a line a question and pair of methods as well")


_NAMES = ("questions", "question", "against", "pairs", "catch", "limit", "fps", "width", "language", "least-caught")


@contextmanager
def _named() -> Iterator[None]:
    """Let errors about values name the options that gave them."""
    from ...physics.errors import InvalidInputError

    try:
        yield
    except InvalidInputError as error:
        if str(error).partition(" must ")[0] not in _NAMES:
            raise
        raise InvalidInputError(f"--{error}") from error


def _make(options: argparse.Namespace) -> None:
    from ...physics.errors import require
    from ..evaluation.study import StudyOptions, make_study, method_clips, questions_of
    from ..evaluation.study.trials import trials_of
    from ..evaluation.study.words import LANGUAGES
    from ..files import check_text_output
    from .messages import say
    from .names import named_as
    from .watching import progress_of

    require("--language", options.language, options.language in LANGUAGES, f"one of {', '.join(LANGUAGES)}")
    methods = method_clips(options.clips)
    with _named():
        trials = trials_of(
            methods,
            against=options.against,
            most=options.pairs,
            catch=options.catch,
            practice=options.practice,
            seed=options.seed,
        )
        chosen = StudyOptions(
            questions_of(options.questions, options.question, language=options.language),
            language=options.language,
            title=options.title,
            rate=options.fps,
            longest=options.width,
            limit=options.limit,
            beside=options.beside,
        )
    page = Path(options.output)
    with named_as("--output", "the name"):
        check_text_output(page, ".html")
    with ExitStack() as bars:
        stages = progress_of(options, bars)
        study = make_study(page, methods, trials, chosen, progress=lambda done, total: stages("encode", done, total))
    if not options.quiet:
        counts = {kind: sum(each.kind == kind for each in trials) for kind in ("pair", "catch")}
        size = page.stat().st_size / 1e6
        say(f"{page}: study {study}, {counts['pair']} pairs and {counts['catch']} catch trials, {size:.1f} MB")
        say(f"{page.with_name(page.stem + '.key.json')}: keep it, and from raters")


def _results(options: argparse.Namespace) -> None:
    from ..evaluation.study import read_files, results_of
    from ..evaluation.study.tables import results_csv, results_json, results_text
    from ..files import check_text_output, write_text
    from .messages import show
    from .names import named_as

    if options.csv is not None:
        with named_as("--csv", "the name"):
            check_text_output(options.csv, ".csv")
        _check_not_read(options.csv, [*options.answers, *filter(None, [options.key])])
    key, files = read_files([Path(each) for each in options.answers], options.key and Path(options.key))
    with _named():
        results: StudyResults = results_of(key, files, against=options.against, least_caught=options.least_caught)
    if options.csv is not None:
        write_text(options.csv, results_csv(results))
    show(results_json(results) if options.json else results_text(results))


def _check_not_read(output: str, read: Sequence[str]) -> None:
    """Refuse to replace a rater's answers or the key."""
    from ...physics.errors import InvalidInputError

    if Path(output).exists() and any(Path(each).exists() and Path(output).samefile(each) for each in read):
        raise InvalidInputError(f"--csv must not be a file that is read. Got: {output}")
