"""The command line: ``physanimator`` or ``python -m physanimator``. Parsing and reporting only."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import __version__

if TYPE_CHECKING:
    from .physics.collision import Contact
    from .rendering.animation import Animation, StageProgress

__all__ = ["main"]

EXAMPLE = Path(__file__).resolve().parent / "workflows" / "example"

FAILED = 1
BAD_INPUT = 2
INTERRUPTED = 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        arguments: what follows the program's name; the process's own when None.

    Returns:
        The exit status: 0, 1 when the disk is full or the like, 2 for bad input, 130 when interrupted.
    """
    options = _parser().parse_args(arguments)
    from .physics.errors import PhysAnimatorError

    try:
        options.run(options)
    except PhysAnimatorError as error:
        print(f"physanimator: {error}", file=sys.stderr)
        return BAD_INPUT
    except OSError as error:
        print(f"physanimator: {error}", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        print("physanimator: interrupted", file=sys.stderr)
        return INTERRUPTED
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="physanimator", description="Set parts of a still illustration in motion.", allow_abbrev=False
    )
    parser.add_argument("--version", action="version", version=f"physanimator {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    _add_animate(commands.add_parser("animate", help="animate an illustration", allow_abbrev=False))
    _add_demo(commands.add_parser("demo", help="animate the bundled example", allow_abbrev=False))
    _add_figure(commands.add_parser("figure", help="draw a figure that explains the controls", allow_abbrev=False))
    schema = commands.add_parser("schema", help="print the JSON Schema of scene files", allow_abbrev=False)
    schema.set_defaults(run=_schema)
    return parser


def _add_animate(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(run=_animate)
    parser.description = (
        "Animate the parts of an illustration that masks or query points select. Without a scene, the parts are"
        " held where they are attached and a gentle wind blows."
    )
    parser.add_argument("image", metavar="IMAGE", help="the illustration (PNG, JPEG, WebP)")
    parts = parser.add_argument_group("what moves (at least one)")
    parts.add_argument(
        "--mask",
        metavar="MASK",
        action="extend",
        nargs="+",
        default=[],
        help="picture of the same size, white where a part is; may be repeated, later parts lie in front",
    )
    parts.add_argument(
        "--points",
        metavar="FILE",
        action="append",
        default=[],
        help="clicks on one part: lines of x,y,label (1 on the part, 0 beside it) or JSON; may be repeated",
    )
    how = parser.add_argument_group("how it moves")
    how.add_argument("--scene", metavar="FILE", help="scene file (JSON) with strokes, rig points and materials")
    how.add_argument(
        "--preset",
        metavar="NAME",
        action="extend",
        nargs="+",
        help="hair, ribbon, cloth, leaf or jelly; one for all parts or one for each (default: hair)",
    )
    how.add_argument("--sway", metavar="HZ", type=float, help="how often parts sway a second (default: the preset's)")
    how.add_argument(
        "--attach", choices=("auto", "top", "bottom", "left", "right"), help="side at which parts are held"
    )
    how.add_argument("--wind", metavar="STRENGTH", type=float, help="0 calm, 1 gentle (default), 3 storm")
    how.add_argument(
        "--wind-angle", metavar="DEG", type=float, help="where the wind blows to: 0 right (default), 90 up"
    )
    how.add_argument(
        "--turbulence",
        metavar="SHARE",
        type=float,
        help="blow everywhere in gusts and with eddies (0 none, 1 wild) instead of in strokes that pass",
    )
    how.add_argument("--contact", action="store_true", help="parts touch instead of passing through each other")
    how.add_argument(
        "--collider",
        metavar="MASK",
        action="extend",
        nargs="+",
        default=[],
        help="picture of the same size, white where something stands still that parts keep out of; implies --contact",
    )
    how.add_argument("--spacing", metavar="PX", type=float, help="distance of mesh vertices (default: from the mask)")
    _add_output(parser, output=None)


def _add_demo(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(run=_demo)
    parser.description = "Animate the bundled example: hair, cape, ribbon and a plant in the wind."
    _add_output(parser, output="demo.mp4")


def _add_figure(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(run=_figure)
    parser.description = "Draw one of the figures that show what the controls do, from simulations made on the spot."
    parser.add_argument(
        "name",
        choices=("stiffness", "strokes", "collision"),
        help="stiffness: a ball under a sweep of Young's modulus; strokes: the example under strokes of different"
        " direction and strength; collision: soft balls that meet, with contact and without",
    )
    parser.add_argument("--output", "-o", metavar="OUT", required=True, help="picture to write (PNG, JPEG, WebP)")
    parser.add_argument("--quiet", "-q", action="store_true", help="no progress bar")


def _add_output(parser: argparse.ArgumentParser, *, output: str | None) -> None:
    drawing = parser.add_argument_group("what is written")
    drawing.add_argument(
        "--output",
        "-o",
        metavar="OUT",
        required=output is None,
        default=output,
        help=".mp4, .webm (the moving parts, transparent), .gif, .webp, .apng, or a folder ending in / for"
        " numbered PNG files" + (f" (default: {output})" if output else ""),
    )
    drawing.add_argument("--frames", metavar="N", type=int, help="number of frames (default: 72, or the loop's)")
    drawing.add_argument(
        "--loop", metavar="SECONDS", type=float, help="make a seamless loop of this length (its first frame moves, too)"
    )
    drawing.add_argument(
        "--skip", metavar="N", type=int, default=0, help="leave out the first N frames, in which the motion settles in"
    )
    drawing.add_argument(
        "--width", metavar="PX", type=int, help="width of what is written (default: the illustration's)"
    )
    drawing.add_argument("--fps", metavar="F", type=float, help="frames a second (default: the scene's, or 24)")
    drawing.add_argument(
        "--background",
        choices=("picture", "transparent"),
        help="behind the moving parts (default: transparent for .webm, else the picture)",
    )
    drawing.add_argument(
        "--interpolate", metavar="N", type=int, default=1, help="draw every N-th frame, fill in the rest"
    )
    drawing.add_argument("--plate", metavar="IMAGE", help="the illustration without its moving parts, if you have it")
    drawing.add_argument("--save-sketch", metavar="OUT", help="also write the moving line drawing")
    drawing.add_argument("--save-flow", metavar="OUT", help="also write the optical flow as colours")
    drawing.add_argument(
        "--preview", metavar="OUT", help="also write the animation with meshes, pins and strokes on it"
    )
    data = parser.add_argument_group("data for other programs")
    data.add_argument(
        "--save-tracks",
        metavar="OUT.json",
        help="write paths of points for motion-controlled video models: a list of {x, y} for each point",
    )
    data.add_argument("--track-points", metavar="N", type=int, help="points on the moving parts (default: 64)")
    data.add_argument("--track-static", metavar="N", type=int, help="points of the background (default: 16)")
    data.add_argument("--track-frames", metavar="N", type=int, help="samples over the clip (default: one a frame)")
    data.add_argument("--save-motion", metavar="OUT.json", help="write every vertex of the meshes in every frame")
    data.add_argument("--save-svg", metavar="OUT.svg", help="write the moving meshes as an SVG that plays in a browser")
    volume = parser.add_mutually_exclusive_group()
    volume.add_argument("--verbose", "-v", action="store_true", help="report sizes and the time of each stage")
    volume.add_argument("--quiet", "-q", action="store_true", help="no progress bars")


def _schema(options: argparse.Namespace) -> None:
    import json

    from .physics.scene_json import scene_schema

    print(json.dumps(scene_schema(), indent=2))


def _demo(options: argparse.Namespace) -> None:
    _check_outputs(options)
    image, masks, scene = _example()
    _run(options, image, masks=masks, scene=scene)


def _example() -> tuple[Any, list[Any], Any]:
    """The bundled illustration, the masks of its parts, and its scene document."""
    from .physics.json_text import read_json
    from .rendering.images import load_image, load_mask

    scene = read_json((EXAMPLE / "scene.json").read_text(encoding="utf-8"))
    image = load_image(EXAMPLE / "illustration.png")
    height, width = image.shape[:2]
    masks = [EXAMPLE / f"mask_{body['name']}.png" for body in scene["bodies"]]
    return image, [load_mask(path, width=width, height=height) for path in masks], scene


def _figure(options: argparse.Namespace) -> None:
    from .rendering.collision_figure import collision_figure
    from .rendering.figures import stiffness_figure, strokes_figure
    from .rendering.images import check_image_output, load_image, save_image

    check_image_output(options.output)
    with ExitStack() as bars:
        stages = None if options.quiet else _progress_bars(bars)
        progress = None if stages is None else lambda done, total: stages("simulate", done, total)
        if options.name == "stiffness":
            figure = stiffness_figure(progress=progress)
        elif options.name == "collision":
            figure = collision_figure(progress=progress)
        else:
            from .physics.meshing import mesh_from_mask
            from .physics.scene_json import scene_from_dict

            image, masks, document = _example()
            scene = scene_from_dict(document, meshes=[mesh_from_mask(mask) for mask in masks])
            figure = strokes_figure(image, masks, scene, load_image(EXAMPLE / "clean_plate.png"), progress=progress)
    save_image(options.output, figure)
    if not options.quiet:
        print(f"{options.output}: {figure.shape[1]} x {figure.shape[0]} px")


def _animate(options: argparse.Namespace) -> None:
    from .physics.errors import InvalidInputError
    from .physics.json_text import read_json
    from .rendering.images import load_image, load_mask

    if not options.mask and not options.points:
        raise InvalidInputError("animate needs --mask or --points to know what moves. Got: neither")
    wind = {"attach": options.attach, "wind_strength": options.wind, "wind_angle": options.wind_angle}
    wind["turbulence"] = options.turbulence
    changes = {name: value for name, value in wind.items() if value is not None}
    if options.scene and changes:
        raise InvalidInputError("--attach, --wind, --wind-angle and --turbulence work without --scene. Got: both")
    _check_outputs(options)
    scene = read_json(_text(options.scene, "scene")) if options.scene else None
    image = load_image(options.image)
    height, width = image.shape[:2]
    _run(
        options,
        image,
        masks=[load_mask(path, width=width, height=height) for path in options.mask],
        points=[_text(path, "points") for path in options.points],
        scene=scene,
        preset=options.preset,
        sway=options.sway,
        spacing=options.spacing,
        contact=_contact(options, scene),
        colliders=[load_mask(path, width=width, height=height) for path in options.collider],
        **changes,
    )


def _contact(options: argparse.Namespace, scene: Any) -> Contact | None:
    """The usual contact, unless the scene has its own."""
    from .physics.collision import Contact

    wanted = options.contact or options.collider
    return Contact() if wanted and not (isinstance(scene, dict) and scene.get("contact")) else None


def _run(options: argparse.Namespace, image: Any, **inputs: Any) -> None:
    """Animate, write everything that was asked for, and report."""
    from .physics.advice import advice
    from .pipeline import animate
    from .rendering.images import load_image

    plate = load_image(options.plate) if options.plate else None
    with ExitStack() as bars:
        progress = None if options.quiet else _progress_bars(bars)
        animation = animate(
            image,
            frames=options.frames,
            loop=options.loop,
            skip=options.skip,
            frame_rate=options.fps,
            plate=plate,
            progress=progress,
            **inputs,
        )
        for sentence in advice(animation.scene):
            print(f"physanimator: warning: {sentence}", file=sys.stderr)
        animation.save(
            options.output,
            transparent=_is_transparent(options),
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
    if options.verbose:
        _report(animation)
    if not options.quiet:
        print(f"{options.output}: {len(animation)} frames at {animation.motion.frame_rate:g} frames a second")


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


def _is_transparent(options: argparse.Namespace) -> bool:
    if options.background is None:
        return Path(options.output).suffix.lower() == ".webm"
    return bool(options.background == "transparent")


def _check_outputs(options: argparse.Namespace) -> None:
    from .physics.errors import InvalidInputError
    from .physics.tracks import check_track_options
    from .rendering.text_files import check_text_output
    from .rendering.video import check_output

    check_output(options.output, alpha=_is_transparent(options))
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


def _text(path: str, name: str) -> str:
    from .physics.errors import InvalidInputError

    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not text"
        raise InvalidInputError(f"{name} must be a readable text file. Got: {path}: {reason}") from None


def _progress_bars(stack: ExitStack) -> StageProgress:
    """A bar on standard error for each stage, which appears with its first step."""
    from tqdm import tqdm

    bars: dict[str, Any] = {}

    def advance(stage: str, done: int, total: int) -> None:
        if stage not in bars:
            bars[stage] = stack.enter_context(tqdm(total=total, desc=f"{stage:<8}", unit="frame", file=sys.stderr))
        bars[stage].update(done - bars[stage].n)
        if done == total:
            bars[stage].close()

    return advance


def _report(animation: Animation) -> None:
    """Sizes and times on standard error."""
    from .physics.simulation import plan

    planned = plan(animation.scene, frames=len(animation))
    for number, body in enumerate(animation.scene.bodies):
        name = body.name or f"part {number + 1}"
        print(f"{name}: {len(body.mesh.vertices)} vertices, {len(body.mesh.triangles)} triangles", file=sys.stderr)
    print(f"{planned.substeps_per_frame:g} steps of the simulation a frame", file=sys.stderr)
    loop = animation.motion.loop
    if loop is not None:
        print(
            f"loop of {loop.seconds:g} s after {loop.cycles} cycles, {loop.residual:.2g} px apart before it was closed",
            file=sys.stderr,
        )
    for stage, seconds in animation.seconds.items():
        print(f"{stage:<10}{seconds:8.2f} s", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
