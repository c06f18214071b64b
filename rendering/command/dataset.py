"""The command about training data; it loads the training only when it runs."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...physics.progress import Progress

__all__ = ["add_dataset"]

LAYOUTS = ("musubi", "diffsynth", "videox", "ltx")


def add_dataset(parser: argparse.ArgumentParser) -> None:
    """All that ``physanimator dataset`` takes."""
    parser.description = "Make, look at and pass on training data for the sketch ControlNets."
    commands = parser.add_subparsers(required=True, metavar="WHAT", parser_class=type(parser))
    for name, add, run, summary in (
        ("build", _add_build, _build, "cut videos into clips, keep those that are worth training on, draw sketches"),
        ("show", _add_show, _show, "draw a contact sheet and histograms of what was kept and dropped"),
        ("encode", _add_encode, _encode, "compute latents and embeddings of all clips, once"),
        ("simulate", _add_simulate, _simulate, "make clips with our own simulator: frames, sketches, exact flow"),
        ("export", _add_export, _export, "write the data as other trainers read it"),
    ):
        command = commands.add_parser(name, help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
        add(command)
        command.add_argument("--quiet", "-q", action="store_true", help="no progress bars and no report")
        command.set_defaults(run=run)


def _add_build(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Cut videos at their cuts, take out repeated drawings and black bars, keep clips that are long enough and"
        " neither still nor torn, and draw their sketches. A stopped build goes on where it was: videos that are done"
        " are left out. Clips are H.264 at CRF 12 and 4:4:4, about 41 dB."
    )
    parser.add_argument("video", metavar="VIDEO_OR_FOLDER", nargs="+", help="videos, and folders of videos")
    parser.add_argument("--output", "-o", metavar="DATA", help="the data folder; not needed with --dry-run")
    parser.add_argument("--licence", default="", metavar="TEXT", help="under which these videos may be used: recorded")
    _add_making(parser)
    scores = parser.add_argument_group("which clips are kept")
    scores.add_argument("--min-frames", type=int, default=24, help="fewest frames (default: %(default)s)")
    scores.add_argument(
        "--min-score", type=float, default=0.05, help="lowest dynamics score: less stands still (default: %(default)s)"
    )
    scores.add_argument(
        "--max-score", type=float, default=0.7, help="highest dynamics score: more tears past (default: %(default)s)"
    )
    scores.add_argument("--index", metavar="FILE.csv", help="take scores from this index instead of computing them")
    scores.add_argument("--score-column", metavar="NAME", help="of the index")
    parser.add_argument(
        "--longest", type=int, default=240, help="frames of the video in a clip; longer shots are split (default: 240)"
    )
    parser.add_argument("--workers", type=int, help="processes (default: one fewer than there are cores, at most 8)")
    parser.add_argument("--dry-run", action="store_true", help="count what would be kept and why; write nothing")


def _add_making(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--size",
        default="512x320",
        metavar="WxH",
        help="of the clips, in multiples of 64 px: 512x320 for ToonCrafter, 576x320 for LVCD. Frames are scaled evenly"
        " until they cover it, and what stands over is cut off on both sides (default: %(default)s)",
    )
    parser.add_argument(
        "--fps",
        type=float,
        default=0.0,
        help="highest frames a second (default: as the video's, without repeated drawings)",
    )
    parser.add_argument(
        "--lines",
        metavar="FILE",
        help="weights of the line drawing network that draws the sketches, such as informative drawings' sk_model.pth;"
        " without it our own extractor does",
    )
    parser.add_argument("--device", default="auto", help="where the network computes (default: %(default)s)")


def _add_show(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("data", metavar="DATA", help="the data folder")
    parser.add_argument("--output", "-o", metavar="OUT.png", help="picture to write (default: DATA/contact_sheet.png)")
    parser.add_argument("--clips", type=int, default=24, help="kept clips that are shown (default: %(default)s)")


def _add_encode(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Compute latents and embeddings of all clips with the frozen networks, once. They are kept as safetensors"
        " beside the clips, with hashes of clip and model; clips that are encoded already are left out."
    )
    parser.add_argument("data", metavar="DATA", help="the data folder")
    which = parser.add_mutually_exclusive_group(required=True)
    which.add_argument("--svd", metavar="FILE", help="for LVCD: Stable Video Diffusion, its file or diffusers folder")
    which.add_argument("--tooncrafter", metavar="FILE", help="for ToonCrafter: its file")
    parser.add_argument("--image-encoder", metavar="FILE", help="where ToonCrafter's file holds none")
    parser.add_argument("--text-encoder", metavar="FILE", help="where ToonCrafter's file holds none")
    parser.add_argument("--device", default="auto", help="where to compute (default: %(default)s)")


def _add_simulate(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Make clips from artwork with random scenes: wind, strokes and materials. Layered artwork moves as its layers'"
        " names say; a flat picture needs --mask. Without artwork, the bundled example is taken."
    )
    parser.add_argument("artwork", metavar="ARTWORK", nargs="*", help="PSD, OpenRaster or layer folder; or one picture")
    parser.add_argument("--mask", nargs="+", action="extend", default=[], metavar="FILE", help="parts of the picture")
    parser.add_argument("--clips", type=int, required=True, metavar="N", help="how many clips there shall be of it")
    parser.add_argument("--output", "-o", metavar="DATA", required=True, help="the data folder")
    parser.add_argument("--frames", type=int, default=48, help="of a clip (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="of all chance (default: %(default)s)")
    parser.add_argument("--licence", default="", metavar="TEXT", help="under which the artwork may be used: recorded")
    _add_making(parser)


def _add_export(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Write the kept clips as another trainer reads them: musubi-tuner's TOML with control_directory,"
        " DiffSynth-Studio's CSV, VideoX-Fun's JSON, or ltx-trainer's JSON."
    )
    parser.add_argument("data", metavar="DATA", help="the data folder")
    parser.add_argument("--layout", choices=LAYOUTS, required=True, help="whose")
    parser.add_argument("--output", "-o", metavar="FOLDER", help="folder to write (default: DATA/export_LAYOUT)")
    parser.add_argument(
        "--caption",
        default="animation",
        metavar="TEXT",
        help="text of all clips; a clip's own is read from DATA/captions/NAME.txt (default: %(default)s)",
    )


def _build(options: argparse.Namespace) -> None:
    from ...physics.errors import InvalidInputError
    from ..training.build_run import BuildWork, build, usual_workers
    from ..training.building import BuildOptions
    from ..training.data_journal import check_data_folder
    from ..training.data_summary import DataCount
    from ..training.score_column import read_scores
    from ..training.selection import Bounds
    from ..training.source_videos import videos_in
    from .messages import say

    if options.output is None and not options.dry_run:
        raise InvalidInputError("--output must name the data folder, unless it is --dry-run. Got: none")
    if (options.index is None) != (options.score_column is None):
        raise InvalidInputError("--index and --score-column must be given together. Got: one of them")
    data = None if options.dry_run else Path(options.output)
    with _named():
        if data is not None:
            check_data_folder(data)
        bounds = Bounds(options.min_frames, options.min_score, options.max_score)
        making = BuildOptions(options.size, options.fps, options.longest, bounds)
    videos = videos_in([Path(each) for each in options.video])
    scores, scored_by = None, ""
    if options.index is not None:
        with _named():
            scores = read_scores(Path(options.index), options.score_column, videos)
        scored_by = f"{Path(options.index).name}: {options.score_column}"
    lines = None if options.lines is None else Path(options.lines)
    work = BuildWork(data, making, lines, options.device, options.licence, scored_by)
    count = DataCount()
    workers = usual_workers() if options.workers is None else options.workers
    with _named(), _bar(options, "build") as progress:
        done_before = build(
            videos,
            work,
            workers=workers,
            scores=scores,
            progress=progress,
            heard=lambda _, records: count.add(records),
        )
    if options.quiet and not options.dry_run:
        return
    if done_before:
        say(f"done before: {done_before} of {len(videos)} videos")
    for sentence in count.sentences():
        say(sentence)


def _show(options: argparse.Namespace) -> None:
    from ..pictures import check_image_output, save_image
    from ..training.contact_sheet import contact_sheet
    from ..training.data_summary import DataCount, newest_records
    from .messages import say

    data = Path(options.data)
    records = newest_records(data)
    output = options.output or str(data / "contact_sheet.png")
    check_image_output(output)
    with _named(), _bar(options, "draw") as progress:
        sheet = contact_sheet(data, records, most=options.clips, progress=progress)
    save_image(output, sheet)
    if not options.quiet:
        count = DataCount()
        count.add(records)
        for sentence in [*count.sentences(), f"{output}: {sheet.shape[1]} x {sheet.shape[0]} px"]:
            say(sentence)


def _encode(options: argparse.Namespace) -> None:
    from ..neural.devices import device_of
    from ..training.encoding import encode_for_svd, encode_for_tooncrafter
    from .messages import say

    device = device_of(options.device)
    data = Path(options.data)
    with _bar(options, "encode") as progress:
        if options.svd is not None:
            made = encode_for_svd(data, Path(options.svd), device=device, progress=progress)
        else:
            made = encode_for_tooncrafter(
                data,
                Path(options.tooncrafter),
                image_encoder=_path(options.image_encoder),
                text_encoder=_path(options.text_encoder),
                device=device,
                progress=progress,
            )
    if not options.quiet:
        say(f"{data}: {made} clips encoded now")


def _simulate(options: argparse.Namespace) -> None:
    from ..training.building import BuildOptions
    from ..training.simulating import SimulationWork, simulate_clips
    from .messages import say

    with _named():
        making = BuildOptions(options.size, options.fps)
        work = SimulationWork(
            Path(options.output),
            making,
            clips=options.clips,
            frames=options.frames,
            seed=options.seed,
            lines=_path(options.lines),
            device=options.device,
            licence=options.licence,
        )
        with _bar(options, "simulate") as progress:
            made = simulate_clips([Path(each) for each in options.artwork], options.mask, work, progress=progress)
    if not options.quiet:
        say(f"{options.output}: {made} clips made now")


def _export(options: argparse.Namespace) -> None:
    from ..training.layouts import export_data
    from .messages import say

    data = Path(options.data)
    output = Path(options.output) if options.output else data / f"export_{options.layout}"
    with _bar(options, "export") as progress:
        hint = export_data(data, output, options.layout, caption=options.caption, progress=progress)
    if not options.quiet:
        say(f"{output}: {hint}")


def _path(given: str | None) -> Path | None:
    return None if given is None else Path(given)


@contextmanager
def _bar(options: argparse.Namespace, stage: str) -> Iterator[Progress]:
    from .watching import progress_of

    with ExitStack() as bars:
        advance = progress_of(options, bars)
        yield lambda done, total: advance(stage, done, total)


_NAMES = {"least_frames": "--min-frames", "least_score": "--min-score", "most_score": "--max-score"} | {
    name: f"--{name.replace('_', '-')}"
    for name in ("output", "index", "score_column", "size", "fps", "longest", "workers", "clips", "frames", "seed")
}


@contextmanager
def _named() -> Iterator[None]:
    """Let errors about values name the options that gave them."""
    from ...physics.errors import InvalidInputError

    try:
        yield
    except InvalidInputError as error:
        text = str(error)
        name = text.partition(" must ")[0]
        if name not in _NAMES:
            raise
        raise InvalidInputError(_NAMES[name] + text[len(name) :]) from error
