"""What each command does with its options."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ... import __version__

if TYPE_CHECKING:
    from ..animation import StageProgress
    from ..options import Timing, Watch

__all__ = ["main"]

EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example"

FAILED = 1
BAD_INPUT = 2
INTERRUPTED = 130
NOBODY_READS = 141


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        arguments: what follows the program's name; the process's own when None.

    Returns:
        The exit status: 0, 1 when the disk is full or the like, 2 for bad input, 128 and the number of the signal that
        ended it, which is 130 for Ctrl+C and 141 where nobody reads what is printed.
    """
    from ..files import ending_signals, ignore_signals, remove_unfinished
    from .messages import printable_streams, warn

    with printable_streams(), ending_signals():
        try:
            return _status(arguments)
        except KeyboardInterrupt as ended:
            ignore_signals()
            status = getattr(ended, "status", INTERRUPTED)
            warn("physanimator: interrupted" if status == INTERRUPTED else f"physanimator: ended by {ended}")
            return status
        finally:
            remove_unfinished()


def _status(arguments: Sequence[str] | None) -> int:
    """Run a command, and say what went wrong."""
    from ...physics.errors import PhysAnimatorError
    from .messages import warn
    from .names import named_by_options

    options = _parser().parse_args(arguments)
    try:
        with named_by_options(options):
            options.run(options)
    except PhysAnimatorError as error:
        warn(f"physanimator: {error}")
        return BAD_INPUT
    except BrokenPipeError:
        return NOBODY_READS
    except OSError as error:
        where = "" if error.filename is None else f"{error.filename}: "
        warn(f"physanimator: {where}{error.strerror or error}")
        return FAILED
    except MemoryError:
        warn("physanimator: the memory does not suffice for a picture of this size")
        return FAILED
    return 0


def _parser() -> argparse.ArgumentParser:
    from .options import add_animate, add_demo, add_figure, add_layers, add_measure
    from .parsing import CommandParser, PictureParser

    parser = CommandParser(
        prog="physanimator", description="Set parts of a still illustration in motion.", allow_abbrev=False
    )
    parser.add_argument("--version", action="version", version=f"physanimator {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND", parser_class=PictureParser)
    for name, run, add_options, summary in (
        ("animate", _animate, add_animate, "animate an illustration"),
        ("demo", _demo, add_demo, "animate the bundled example"),
        ("figure", _figure, add_figure, "draw a figure that explains the controls"),
        ("layers", _layers, add_layers, "list the layers of a PSD or OpenRaster file, and what would move"),
        ("measure", _measure, add_measure, "measure a clip against the motion that it should show"),
        ("schema", _schema, None, "print the JSON Schema of scene files"),
    ):
        command = commands.add_parser(name, help=summary, allow_abbrev=False)
        command.set_defaults(run=run, command=name)
        if add_options is not None:
            add_options(command)
    return parser


def _schema(options: argparse.Namespace) -> None:
    import json

    from ...physics.document import scene_schema
    from .messages import show

    show(json.dumps(scene_schema(), indent=2))


def _demo(options: argparse.Namespace) -> None:
    from .outputs import check_outputs, check_sizes

    check_outputs(options, bundled=_bundled())
    image, masks, scene = _example()
    check_sizes(options, image)
    _run(options, image, masks=masks, scene=scene)


def _bundled() -> list[Path]:
    """What is read of the bundled example."""
    return sorted(path for path in EXAMPLE.iterdir() if path.suffix in (".json", ".png"))


def _example() -> tuple[Any, list[Any], Any]:
    """The bundled illustration, the masks of its parts, and its scene document."""
    from ...physics.document import read_json
    from ..pictures import load_image, load_mask

    scene = read_json((EXAMPLE / "scene.json").read_text(encoding="utf-8"))
    image = load_image(EXAMPLE / "illustration.png")
    height, width = image.shape[:2]
    masks = [EXAMPLE / f"mask_{body['name']}.png" for body in scene["bodies"]]
    return image, [load_mask(path, width=width, height=height) for path in masks], scene


def _figure(options: argparse.Namespace) -> None:
    from ..figures import collision_figure, presets_figure, stiffness_figure, strokes_figure
    from ..pictures import check_image_output, load_image, save_image
    from .files import check_apart
    from .messages import say
    from .names import named_as

    check_apart(options, bundled=_bundled())
    with named_as("--output", "output", "a picture's name"):
        check_image_output(options.output)
    with ExitStack() as bars:
        stages = _progress(options, bars)

        def progress(done: int, total: int) -> None:
            stages("simulate", done, total)

        if options.name == "stiffness":
            figure = stiffness_figure(progress=progress)
        elif options.name == "collision":
            figure = collision_figure(progress=progress)
        elif options.name == "presets":
            figure = presets_figure(progress=progress)
        else:
            from ...physics.document import scene_from_dict
            from ...physics.mesh import mesh_from_mask

            image, masks, document = _example()
            scene = scene_from_dict(document, meshes=[mesh_from_mask(mask) for mask in masks])
            figure = strokes_figure(image, masks, scene, load_image(EXAMPLE / "clean_plate.png"), progress=progress)
    save_image(options.output, figure)
    if not options.quiet:
        say(f"{options.output}: {figure.shape[1]} x {figure.shape[0]} px")


def _animate(options: argparse.Namespace) -> None:
    from .inputs import check_inputs, check_taken, read_inputs
    from .outputs import check_outputs, check_sizes

    check_inputs(options)
    check_outputs(options)
    image, inputs = read_inputs(options)
    check_taken(options, image)
    check_sizes(options, image)
    _run(options, image, **inputs)


def _layers(options: argparse.Namespace) -> None:
    from .layers import list_layers

    list_layers(options)


def _measure(options: argparse.Namespace) -> None:
    from ..pictures import over
    from ..pipeline import animate
    from .inputs import check_inputs, check_taken, read_inputs, read_plate
    from .measures import check_measures, measured, table
    from .messages import show

    check_inputs(options)
    check_measures(options)
    image, inputs = read_inputs(options)
    check_taken(options, image)
    image = over(image)  # clips are compared by their colours
    plate = read_plate(options, alpha=False)
    with ExitStack() as bars:
        progress = _progress(options, bars)
        watch = _watch(options, progress, inputs["points"])
        animation = animate(
            image, plate=plate, timing=_timing(options), max_minutes=options.max_minutes, watch=watch, **inputs
        )
        found = measured(options, animation, progress)
    show(table(found, as_json=options.json))


def _run(options: argparse.Namespace, image: Any, **inputs: Any) -> None:
    """Animate, write everything that was asked for, and report."""
    from ...physics.motion import stillness
    from ..composite import pixel_art_hint
    from ..pipeline import animate
    from .inputs import read_plate
    from .messages import say, warn
    from .outputs import background_for, report, write_outputs

    plate = read_plate(options)
    background_for(options, image)
    if not (options.pixel_art or options.quiet):
        for sentence in pixel_art_hint(image, option="--pixel-art"):
            warn(f"physanimator: hint: {sentence}")
    with ExitStack() as bars:
        progress = _progress(options, bars)
        animation = animate(
            image,
            timing=_timing(options),
            plate=plate,
            pixel_art=options.pixel_art,
            max_minutes=options.max_minutes,
            watch=_watch(options, progress, inputs.get("points", ())),
            **inputs,
        )
        for sentence in stillness(animation.motion):
            warn(f"physanimator: warning: {sentence}")
        write_outputs(options, animation, progress)
    if options.verbose:
        report(animation)
    if not options.quiet:
        say(f"{options.output}: {len(animation)} frames at {animation.motion.frame_rate:g} frames a second")


def _timing(options: argparse.Namespace) -> Timing:
    from ..options import Timing

    return Timing(frames=options.frames, loop=options.loop, skip=options.skip, frame_rate=options.fps)


def _watch(options: argparse.Namespace, progress: StageProgress, points: Sequence[str]) -> Watch:
    """Who hears of the work; before the simulation, what is suspicious about the cuts and the scene is said."""
    from ...physics.scene import advice
    from ..options import Watch
    from ..segmentation import judge_points
    from .messages import warn

    def tell(sentences: Sequence[str]) -> None:
        for sentence in sentences:
            warn(f"physanimator: warning: {sentence}")

    named = bool(getattr(options, "mask", None))
    return Watch(
        progress=progress,
        on_cut=lambda cut: tell(judge_points(cut, points)),
        on_scene=lambda scene: tell(advice(scene, masks=not named)),
    )


def _progress(options: argparse.Namespace, stack: ExitStack) -> StageProgress:
    """What is called with every step: it draws bars, unless the user wants none, and hears signals."""
    from ..files import hear_signals

    bars = None if options.quiet else _progress_bars(stack)

    def advance(stage: str, done: int, total: int) -> None:
        hear_signals()
        if bars is not None:
            bars(stage, done, total)

    return advance


def _progress_bars(stack: ExitStack) -> StageProgress | None:
    from .messages import progress_bars

    return progress_bars(stack)
