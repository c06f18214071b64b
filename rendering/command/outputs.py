"""What a command writes: checked before any work, written after it, and reported."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .files import CLIPS, coming_folders, named, writing_order
from .messages import say, warn
from .names import named_as
from .networks import keyframes_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...physics.assembly import SimulationPlan
    from ..animation import Animation
    from ..options import Saving
    from ..stages import StageProgress

__all__ = [
    "background_for",
    "check_layers",
    "check_outputs",
    "check_sizes",
    "draws_opaque",
    "report",
    "saving_of",
    "write_outputs",
]

_TRACKED = ("--track-points", "--track-static", "--track-frames")
_TEXTS = {
    "save_tracks": ".json",
    "save_motion": ".json",
    "save_svg": ".svg",
    "save_scene": ".json",
    "save_gltf": ".glb",
}
_PICTURES = ("save_uncovered", "save_plate")
_EDITABLE = ("save_spine", "save_gltf")

LARGEST_WIDTH = 8192
"""The largest width that can be asked for [px]; its square is the most pixels that a frame may have."""


def check_outputs(options: argparse.Namespace, *, bundled: Sequence[Path] = ()) -> None:
    """Refuse places and sizes that cannot be written, and results in the place of what is read, before any work.

    Args:
        options: of the command.
        bundled: files that the command reads without being told.

    Raises:
        InvalidInputError: the message names the option or the file.
    """
    from ...physics.errors import InvalidInputError
    from ...physics.motion import check_track_options
    from ...physics.scene import check_scene_rate
    from ..composite import Background, background_of
    from ..drawing_checks import check_drawing
    from ..files import is_folder_name, suffix_of
    from ..pictures import OVERLAYS
    from .files import check_apart

    check_apart(options, bundled=bundled)
    # Frames of overlays have an alpha channel whatever the illustration is, unless something else is said.
    by_model = draws_opaque(options)
    usual = Background("parts" if suffix_of(options.output) in OVERLAYS and not by_model else "picture")
    said = (
        background_of(options.background, others=["layers"]) if options.background and not in_layers(options) else usual
    )
    if in_layers(options) and not is_folder_name(options.output):
        raise InvalidInputError(f"--background layers needs --output to end in '/'. Got: {options.output}")
    _check_clips(options, alpha=said.has_alpha)
    keyframes = keyframes_of(options)
    with named_as("--renderer"):
        transparent = said.has_alpha or in_layers(options)
        check_drawing(transparent=transparent, pixel_art=options.pixel_art, by_model=by_model)
    with named_as("--keyframes-at" if keyframes else "--interpolate", "every"):
        check_drawing(
            transparent=said.has_alpha,
            every=options.interpolate,
            pixel_art=options.pixel_art,
            in_betweens=bool(keyframes),
        )
    if options.fps is not None:
        check_scene_rate(options.fps)
    _check_texts(options)
    _check_pictures(options)
    _check_editable(options)
    _check_vectors(options)
    if options.width is not None and not 16 <= options.width <= LARGEST_WIDTH:
        raise InvalidInputError(f"--width must be 16 to {LARGEST_WIDTH} px. Got: {options.width}")
    tracked = (options.track_points, options.track_static, options.track_frames)
    if not options.save_tracks and tracked != (None, None, None):
        raise InvalidInputError(f"{_TRACKED[0]}, {_TRACKED[1]} and {_TRACKED[2]} need --save-tracks. Got: without")
    for option, name, number in zip(_TRACKED, ("points", "static_points", "frames"), tracked, strict=True):
        with named_as(option, name):
            check_track_options(**{name: number})


def draws_opaque(options: argparse.Namespace) -> bool:
    """Whether a model draws frames, or paints in them: they are opaque then."""
    return getattr(options, "renderer", None) not in (None, "composite")


def in_layers(options: argparse.Namespace) -> bool:
    """Whether each layer is to be written as a sequence of its own."""
    return bool(options.background) and options.background.strip().lower() == "layers"


def check_layers(options: argparse.Namespace, image: Any) -> None:
    """Refuse layers as sequences where they cannot be drawn or written, before any work.

    Args:
        options: of the command.
        image: the illustration, an array or layered artwork.

    Raises:
        InvalidInputError: see above.
    """
    import numpy as np

    from ...physics.errors import require
    from ..layer_sequences import check_layer_sequences, check_part_sequences

    if not in_layers(options):
        return
    require("--pixel-art", "with it", not options.pixel_art, "left out with --background layers")
    require("--interpolate", options.interpolate, options.interpolate == 1, "1 with --background layers")
    require("--keyframes-at", options.keyframes_at, not options.keyframes_at, "left out with --background layers")
    with named_as("--output", "output", "folder"):
        if isinstance(image, np.ndarray):
            check_part_sequences(options.output)
        else:
            check_layer_sequences(image, options.output)


def check_sizes(options: argparse.Namespace, image: NDArray[Any]) -> None:
    """Refuse frames that are too large for what they are written to: the picture is known, nothing is simulated yet.

    Args:
        options: of the command.
        image: the illustration, shape [h, w, 3 or 4].

    Raises:
        InvalidInputError: the message names the format and its limit.
    """
    from ...physics.errors import require
    from ..composite import background_of
    from ..drawing_checks import height_at

    height, width = image.shape[:2]
    if options.width is not None:
        width, height = options.width, height_at(image, options.width)
        held = width * height <= LARGEST_WIDTH**2
        require("--width", f"{width} x {height} px", held, f"such that a frame has at most {LARGEST_WIDTH}^2 pixels")
    alpha = background_of(background_for(options, image)).has_alpha
    _check_clips(options, alpha=alpha, size=(width, height))


def _check_clips(options: argparse.Namespace, *, alpha: bool, size: tuple[int, int] | None = None) -> None:
    from ..pictures import check_output

    coming = coming_folders(options)
    for option, path in named(options, CLIPS):
        with named_as(option, "output"):
            check_output(path, alpha=alpha and option == "--output", size=size, coming=coming)


def _check_texts(options: argparse.Namespace) -> None:
    from ..files import check_text_output

    coming = coming_folders(options)
    for name, suffix in _TEXTS.items():
        for option, path in named(options, (name,)):
            with named_as(option, "output", "the name"):
                check_text_output(path, suffix, coming=coming)


def _check_pictures(options: argparse.Namespace) -> None:
    """Refuse places of single pictures, and a mask of what pixel art does not uncover in parts of pixels."""
    from ...physics.errors import require
    from ..files import check_text_output

    coming = coming_folders(options)
    if options.save_uncovered is not None:
        require("--save-uncovered", "both", not options.pixel_art, "left out with --pixel-art")
        wide = options.soft_edge is None or 0 <= options.soft_edge <= 1000
        require("--soft-edge", options.soft_edge, wide, "0 to 1000 px with --save-uncovered")
    for option, path in named(options, _PICTURES):
        with named_as(option, "output", "the name"):
            check_text_output(path, ".png", coming=coming)


def _check_editable(options: argparse.Namespace) -> None:
    """Refuse places and tolerances of what other programs go on with."""
    from ...physics.errors import require
    from ..editable import check_spine_output
    from ..moving_pieces import check_tolerance

    asked = list(named(options, _EDITABLE))
    needless = options.tolerance is not None and not asked
    require("--tolerance", options.tolerance, not needless, "left out without --save-spine or --save-gltf")
    for option, _ in asked:
        require(option, "both", not options.pixel_art, "left out with --pixel-art")
    if options.tolerance is not None:
        with named_as("--tolerance", "tolerance"):
            check_tolerance(options.tolerance)
    for option, path in named(options, ("save_spine",)):
        with named_as(option, "output", "folder"):
            check_spine_output(path, coming=coming_folders(options))


def _check_vectors(options: argparse.Namespace) -> None:
    """Refuse a place where motion vectors cannot be written, or a machine without what writes them."""
    from ...physics.errors import require
    from ..export import check_vectors_folder

    needless = options.vector_channels is not None and not options.save_vectors
    require("--vector-channels", options.vector_channels, not needless, "left out without --save-vectors")
    for option, path in named(options, ("save_vectors",)):
        with named_as(option, "output", "folder"):
            check_vectors_folder(path, coming=coming_folders(options))


def saving_of(options: argparse.Namespace, image: NDArray[Any]) -> Saving | None:
    """How the animation is written while it is simulated; None where it is written after that, by ``write_outputs``.

    Args:
        options: of the command.
        image: the illustration, shape [h, w, 3 or 4].
    """
    from ..frame_drawing import drawn_elsewhere
    from ..options import Saving

    filled_in = options.interpolate > 1 or keyframes_of(options)
    if drawn_elsewhere() or filled_in or in_layers(options) or writing_order(options)[0] != "output":
        return None
    return Saving(options.output, background_for(options, image), options.width)


def write_outputs(
    options: argparse.Namespace, animation: Animation, progress: StageProgress | None, *, saved: bool = False
) -> None:
    """Write the animation, and all that was asked for beside it.

    Args:
        options: of the command.
        animation: what is written.
        progress: called with the steps.
        saved: whether the animation itself is written already.
    """
    drawn = {"save_sketch": animation.sketches, "save_flow": animation.flows, "preview": animation.previews}
    for name in writing_order(options):
        path = getattr(options, name)
        if name == "save_spine":
            _tell(options, path, animation.save_spine(path, **_tolerance(options), progress=progress))
        elif name == "output" and saved:
            continue
        elif name == "output" and in_layers(options):
            animation.save_layers(path, width=options.width, progress=progress)
        elif name == "output":
            animation.save(
                path,
                background=background_for(options, animation.image),
                every=options.interpolate,
                width=options.width,
                progress=progress,
                keyframes_at=keyframes_of(options),
            )
        else:
            animation.write(drawn[name](progress=progress), path, width=options.width)
    _save_data(options, animation, progress)
    if options.save_vectors:
        animation.save_vectors(options.save_vectors, channels=options.vector_channels or "nuke", progress=progress)
    if options.save_gltf:
        told = animation.save_gltf(options.save_gltf, **_tolerance(options), progress=progress)
        _tell(options, options.save_gltf, told)


def _tolerance(options: argparse.Namespace) -> dict[str, float]:
    return {} if options.tolerance is None else {"tolerance": options.tolerance}


def _tell(options: argparse.Namespace, path: str, told: Sequence[str]) -> None:
    """Say what was written, and warn of what is otherwise than in the frames."""
    written, *warnings = told
    if not options.quiet:
        say(f"{path}: {written}")
    for sentence in warnings:
        warn(f"physanimator: warning: {sentence}")


def report(animation: Animation) -> None:
    """Sizes and times on standard error."""
    from ...physics.assembly import plan

    planned = plan(animation.scene, frames=len(animation))
    for number, body in enumerate(animation.scene.bodies):
        name = body.name or f"part {number + 1}"
        warn(f"{name}: {len(body.mesh.vertices)} vertices, {len(body.mesh.triangles)} triangles")
    warn(f"{planned.substeps_per_frame:g} steps of the simulation a frame")
    warn(_way(animation, planned))
    loop = animation.motion.loop
    if loop is not None:
        warn(
            f"loop of {loop.seconds:g} s after {loop.cycles} cycles, {loop.residual:.2g} px apart before it was closed"
        )
    for stage, seconds in animation.seconds.items():
        warn(f"{stage:<10}{seconds:8.2f} s")
    if animation.networks.uses_networks:
        from ..neural.devices import most_memory

        warn(f"networks on {' with at most '.join(most_memory(animation.networks))} of memory")


def _way(animation: Animation, planned: SimulationPlan) -> str:
    """How the connected parts were computed."""
    if animation.scene.contact is not None:
        return f"connected parts: {planned.parts}, one after the other, as they may touch"
    return f"connected parts: {planned.parts} side by side, a thread for each"


def _save_data(options: argparse.Namespace, animation: Animation, progress: StageProgress | None) -> None:
    """Write what other programs read."""
    if options.save_tracks:
        wanted = {
            "points": options.track_points,
            "static_points": options.track_static,
            "frames": options.track_frames,
            "width": options.width,
            "height": options.width and animation.height_at(options.width),
        }
        animation.save_tracks(options.save_tracks, **{name: n for name, n in wanted.items() if n is not None})
    if options.save_motion:
        animation.save_motion(options.save_motion)
    if options.save_svg:
        animation.save_svg(options.save_svg)
    if options.save_scene:
        animation.save_scene(options.save_scene)
    if options.save_uncovered:
        animation.save_uncovered(options.save_uncovered, **_widths(options), progress=progress)
    if options.save_plate:
        animation.save_plate(options.save_plate)


def _widths(options: argparse.Namespace) -> dict[str, float]:
    """How far the mask of what is uncovered reaches, as far as it is said."""
    said = {"grow": options.grow, "soft_edge": options.soft_edge}
    return {name: value for name, value in said.items() if value is not None}


def background_for(options: argparse.Namespace, image: Any) -> str:
    """The background of what is written, as said or as usual for the illustration and the output.

    Raises:
        InvalidInputError: in-betweens are asked for where it is transparent.
    """
    from ..composite import usual_background
    from ..drawing_checks import check_drawing
    from ..files import suffix_of
    from ..pictures import OVERLAYS, holds_alpha, is_transparent

    if in_layers(options):
        return "transparent"
    if options.background is not None:
        return str(options.background)
    if draws_opaque(options):
        return "picture"
    usual = usual_background(
        transparent_picture=is_transparent(image),
        file_has_alpha=holds_alpha(options.output),
        parts=suffix_of(options.output) in OVERLAYS,
    )
    keyframes = keyframes_of(options)
    with named_as("--keyframes-at" if keyframes else "--interpolate", "every"):
        check_drawing(transparent=usual.has_alpha, every=options.interpolate, in_betweens=bool(keyframes))
    return usual.kind
