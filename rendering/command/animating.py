"""What ``animate`` does: check, read, simulate, draw and write."""

from __future__ import annotations

import argparse
from contextlib import ExitStack
from typing import Any

__all__ = ["animate_and_write", "checked_inputs", "picture_of_inputs", "run_animate"]


def run_animate(options: argparse.Namespace) -> None:
    """All that ``physanimator animate`` does.

    Raises:
        InvalidInputError: an option or a file is unusable.
    """
    image, inputs = checked_inputs(options, begin=True)
    animate_and_write(options, image, **inputs)


def checked_inputs(options: argparse.Namespace, *, begin: bool = False) -> tuple[Any, dict[str, Any]]:
    """The illustration and what moves how, after every check that needs no simulation.

    Args:
        options: of the command.
        begin: start the process in which will be simulated as soon as the options are known to go together: it reads
            its kernels while this one reads pictures.

    Raises:
        InvalidInputError: see above.
    """
    from ...physics.simulation import begin_aside
    from ..artwork import is_artwork_file
    from .inputs import check_inputs, check_taken, read_inputs
    from .networks import check_networks_used
    from .outputs import check_layers, check_outputs, check_sizes

    check_inputs(options)
    check_outputs(options)
    check_networks_used(options)
    if begin and not (options.pixel_art or is_artwork_file(options.image)):
        begin_aside()
    image, inputs = read_inputs(options)
    check_taken(options, image)
    check_layers(options, image)
    check_sizes(options, picture_of_inputs(image))
    return image, inputs


def picture_of_inputs(image: Any) -> Any:
    """The picture that a flat illustration is, or that layered artwork gives."""
    import numpy as np

    from ..parts import picture_of

    return image if isinstance(image, np.ndarray) else picture_of(image)


def animate_and_write(options: argparse.Namespace, image: Any, **inputs: Any) -> None:
    """Animate, write everything that was asked for, and report."""
    from ...physics.motion import stillness
    from ..composite import pixel_art_hint
    from ..pipeline import animate
    from .inputs import read_plate
    from .messages import say, warn
    from .networks import networks_of, timing_of
    from .outputs import background_for, report, saving_of, write_outputs
    from .watching import progress_of, watch_of

    plate = read_plate(options)
    background_for(options, picture_of_inputs(image))
    if not (options.pixel_art or options.quiet):
        for sentence in pixel_art_hint(picture_of_inputs(image), option="--pixel-art"):
            warn(f"physanimator: hint: {sentence}")
    save = saving_of(options, picture_of_inputs(image))
    with ExitStack() as bars:
        progress = progress_of(options, bars)
        animation = animate(
            image,
            timing=timing_of(options),
            plate=plate,
            pixel_art=options.pixel_art,
            max_minutes=options.max_minutes,
            watch=watch_of(options, progress, inputs.get("points", ()), image),
            networks=networks_of(options),
            save=save,
            **inputs,
        )
        for sentence in stillness(animation.motion):
            warn(f"physanimator: warning: {sentence}")
        write_outputs(options, animation, progress, saved=save is not None)
    if options.verbose:
        report(animation)
    if not options.quiet:
        say(f"{options.output}: {len(animation)} frames at {animation.motion.frame_rate:g} frames a second")
