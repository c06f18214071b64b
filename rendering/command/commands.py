"""What each command does with its options."""

from __future__ import annotations

import argparse
from contextlib import ExitStack

from ... import __version__

__all__ = ["command_parser"]


def command_parser() -> argparse.ArgumentParser:
    """What reads the command line; ``run`` of what it gives does the work."""
    from .dataset import add_dataset
    from .evaluate import add_evaluate
    from .options import add_animate, add_demo, add_figure, add_layers, add_measure
    from .parsing import CommandParser, PictureParser
    from .shots import add_shots
    from .study import add_study
    from .training import add_training

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
        ("shots", None, add_shots, "animate a list of illustrations, on all cores or a cluster of machines"),
        ("evaluate", None, add_evaluate, "compare methods on a set of pictures, with a report"),
        ("study", None, add_study, "ask people which of two clips they prefer, and count their answers"),
        ("schema", _schema, None, "print the JSON Schema of scene files"),
        ("dataset", None, add_dataset, "make, look at and pass on training data"),
        ("training", None, add_training, "export what was trained"),
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
    from ...physics.simulation import begin_aside

    if not options.pixel_art:
        begin_aside()  # it reads its kernels while this process imports what it needs
    from .animating import animate_and_write
    from .example import bundled_files, read_example
    from .networks import check_networks_used
    from .outputs import check_layers, check_outputs, check_sizes

    check_outputs(options, bundled=bundled_files())
    check_networks_used(options)
    image, masks, scene = read_example()
    check_layers(options, image)
    check_sizes(options, image)
    animate_and_write(options, image, masks=masks, scene=scene)


def _figure(options: argparse.Namespace) -> None:
    from ..figures import collision_figure, presets_figure, stiffness_figure, strokes_figure
    from ..pictures import check_image_output, load_image, save_image
    from .example import EXAMPLE, bundled_files, read_example
    from .files import check_apart
    from .messages import say
    from .names import named_as
    from .watching import progress_of

    check_apart(options, bundled=bundled_files())
    with named_as("--output", "output", "a picture's name"):
        check_image_output(options.output)
    with ExitStack() as bars:
        stages = progress_of(options, bars)

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

            image, masks, document = read_example()
            scene = scene_from_dict(document, meshes=[mesh_from_mask(mask) for mask in masks])
            figure = strokes_figure(image, masks, scene, load_image(EXAMPLE / "clean_plate.png"), progress=progress)
    save_image(options.output, figure)
    if not options.quiet:
        say(f"{options.output}: {figure.shape[1]} x {figure.shape[0]} px")


def _animate(options: argparse.Namespace) -> None:
    from .animating import run_animate

    run_animate(options)


def _layers(options: argparse.Namespace) -> None:
    from .layers import list_layers

    list_layers(options)


def _measure(options: argparse.Namespace) -> None:
    import numpy as np

    from ..pictures import over
    from ..pipeline import animate
    from .inputs import check_inputs, check_taken, read_inputs, read_plate
    from .measures import check_measures, measured, table
    from .messages import show
    from .networks import check_networks_used, networks_of, timing_of
    from .watching import progress_of, watch_of

    check_inputs(options)
    check_measures(options)
    check_networks_used(options)
    image, inputs = read_inputs(options)
    check_taken(options, image)
    image = over(image) if isinstance(image, np.ndarray) else image  # clips are compared by their colours
    plate = read_plate(options, alpha=False)
    with ExitStack() as bars:
        progress = progress_of(options, bars)
        watch = watch_of(options, progress, inputs["points"], image)
        animation = animate(
            image,
            plate=plate,
            timing=timing_of(options),
            max_minutes=options.max_minutes,
            watch=watch,
            networks=networks_of(options),
            **inputs,
        )
        found = measured(options, animation, progress)
    show(table(found, as_json=options.json))
