"""What a command writes: checked before any work, written after it, and reported."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..physics.plan import SimulationPlan
    from .animation import Animation, StageProgress

__all__ = ["background_for", "check_outputs", "report", "write_outputs"]


def check_outputs(options: argparse.Namespace) -> None:
    """Refuse places and sizes that cannot be written, before any long work.

    Raises:
        InvalidInputError: the message names the option or the file.
    """
    from ..physics.errors import InvalidInputError
    from ..physics.tracks import check_track_options
    from .background import Background, background_of, check_in_betweens
    from .text_files import check_text_output
    from .video import check_output

    said = options.background and background_of(options.background)
    check_output(options.output, alpha=bool(said and said.has_alpha))
    check_in_betweens(said or Background(), options.interpolate, pixel_art=options.pixel_art)
    if options.width is not None and not 16 <= options.width <= 8192:
        raise InvalidInputError(f"--width must be 16 to 8192 px. Got: {options.width}")
    chosen = [options.output]
    for path in (options.save_sketch, options.save_flow, options.preview):
        if path is not None:
            check_output(path)
            chosen.append(path)
    for path, suffix in ((options.save_tracks, ".json"), (options.save_motion, ".json"), (options.save_svg, ".svg")):
        if path is not None:
            check_text_output(path, suffix)
            chosen.append(path)
    tracked = (options.track_points, options.track_static, options.track_frames)
    if not options.save_tracks and tracked != (None, None, None):
        raise InvalidInputError("--track-points, --track-static and --track-frames need --save-tracks. Got: without")
    check_track_options(points=tracked[0], static_points=tracked[1], frames=tracked[2])
    if len({Path(path).resolve() for path in chosen}) < len(chosen):
        raise InvalidInputError(f"every output must have its own name. Got: {', '.join(chosen)}")


def write_outputs(options: argparse.Namespace, animation: Animation, progress: StageProgress | None) -> None:
    """Write the animation, and all that was asked for beside it."""
    animation.save(
        options.output,
        background=background_for(options, animation.image),
        every=options.interpolate,
        width=options.width,
        progress=progress,
    )
    if options.save_sketch:
        animation.write(animation.sketches(progress=progress), options.save_sketch, width=options.width)
    if options.save_flow:
        animation.write(animation.flows(progress=progress), options.save_flow, width=options.width)
    if options.preview:
        animation.write(animation.previews(progress=progress), options.preview, width=options.width)
    _save_data(options, animation)


def report(animation: Animation) -> None:
    """Sizes and times on standard error."""
    from ..physics.simulation import plan

    planned = plan(animation.scene, frames=len(animation))
    for number, body in enumerate(animation.scene.bodies):
        name = body.name or f"part {number + 1}"
        print(f"{name}: {len(body.mesh.vertices)} vertices, {len(body.mesh.triangles)} triangles", file=sys.stderr)
    print(f"{planned.substeps_per_frame:g} steps of the simulation a frame", file=sys.stderr)
    print(_way(animation, planned), file=sys.stderr)
    loop = animation.motion.loop
    if loop is not None:
        print(
            f"loop of {loop.seconds:g} s after {loop.cycles} cycles, {loop.residual:.2g} px apart before it was closed",
            file=sys.stderr,
        )
    for stage, seconds in animation.seconds.items():
        print(f"{stage:<10}{seconds:8.2f} s", file=sys.stderr)


def _way(animation: Animation, planned: SimulationPlan) -> str:
    """How the connected parts were gone about."""
    if animation.scene.contact is not None:
        return f"connected parts: {planned.alone}, which threads advance together where they may touch"
    shared = [f"one shared by up to {threads} threads, where that is faster" for threads in planned.shared]
    alone = [f"{planned.alone} side by side, a thread for each"] if planned.alone else []
    return f"connected parts: {', '.join(shared + alone)}"


def _save_data(options: argparse.Namespace, animation: Animation) -> None:
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


def background_for(options: argparse.Namespace, image: Any) -> str:
    """The background of what is written, as said or as usual for the illustration and the output.

    Raises:
        InvalidInputError: in-betweens are asked for where it is transparent.
    """
    from .background import check_in_betweens, is_transparent, usual_background
    from .video import holds_alpha

    if options.background is not None:
        return str(options.background)
    usual = usual_background(
        transparent_picture=is_transparent(image),
        file_has_alpha=holds_alpha(options.output),
        parts=Path(options.output).suffix.lower() == ".webm",
    )
    check_in_betweens(usual, options.interpolate)
    return usual.kind
