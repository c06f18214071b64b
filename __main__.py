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
    drawing.add_argument("--frames", metavar="N", type=int, help="number of frames (default: 72)")
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
    volume = parser.add_mutually_exclusive_group()
    volume.add_argument("--verbose", "-v", action="store_true", help="report sizes and the time of each stage")
    volume.add_argument("--quiet", "-q", action="store_true", help="no progress bars")


def _schema(options: argparse.Namespace) -> None:
    import json

    from .physics.scene_json import scene_schema

    print(json.dumps(scene_schema(), indent=2))


def _demo(options: argparse.Namespace) -> None:
    from .physics.json_text import read_json
    from .rendering.images import load_image, load_mask

    _check_outputs(options)
    scene = read_json((EXAMPLE / "scene.json").read_text(encoding="utf-8"))
    image = load_image(EXAMPLE / "illustration.png")
    height, width = image.shape[:2]
    masks = [EXAMPLE / f"mask_{body['name']}.png" for body in scene["bodies"]]
    _run(options, image, masks=[load_mask(path, width=width, height=height) for path in masks], scene=scene)


def _animate(options: argparse.Namespace) -> None:
    from .physics.errors import InvalidInputError
    from .physics.json_text import read_json
    from .rendering.images import load_image, load_mask

    if not options.mask and not options.points:
        raise InvalidInputError("animate needs --mask or --points to know what moves. Got: neither")
    wind = {"attach": options.attach, "wind_strength": options.wind, "wind_angle": options.wind_angle}
    changes = {name: value for name, value in wind.items() if value is not None}
    if options.scene and changes:
        raise InvalidInputError("--attach, --wind and --wind-angle work without --scene. Got: both")
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
    from .physics.rigging import unused_rig_points
    from .pipeline import DEFAULT_FRAMES, animate
    from .rendering.images import load_image

    plate = load_image(options.plate) if options.plate else None
    frames = DEFAULT_FRAMES if options.frames is None else options.frames
    with ExitStack() as bars:
        progress = None if options.quiet else _progress_bars(bars)
        animation = animate(
            image,
            frames=frames,
            skip=options.skip,
            frame_rate=options.fps,
            plate=plate,
            progress=progress,
            **inputs,
        )
        for sentence in unused_rig_points(animation.scene):
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
    if options.verbose:
        _report(animation)
    if not options.quiet:
        print(f"{options.output}: {len(animation)} frames at {animation.motion.frame_rate:g} frames a second")


def _is_transparent(options: argparse.Namespace) -> bool:
    if options.background is None:
        return Path(options.output).suffix.lower() == ".webm"
    return bool(options.background == "transparent")


def _check_outputs(options: argparse.Namespace) -> None:
    from .physics.errors import InvalidInputError
    from .rendering.video import check_output

    check_output(options.output, alpha=_is_transparent(options))
    if options.width is not None and not 16 <= options.width <= 8192:
        raise InvalidInputError(f"--width must be 16 to 8192 px. Got: {options.width}")
    chosen = [options.output]
    for path in (options.save_sketch, options.save_flow, options.preview):
        if path is not None:
            check_output(path)
            chosen.append(path)
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
    for stage, seconds in animation.seconds.items():
        print(f"{stage:<10}{seconds:8.2f} s", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
