"""The options of the command line, a function for each group of them."""

from __future__ import annotations

import argparse

from ...physics.limits import DEFAULT_MINUTES
from .network_options import add_networks
from .physics_options import add_physics

__all__ = ["add_animate", "add_demo", "add_figure", "add_layers", "add_measure"]

_MASK = (
    "white where a part is; without white, one colour on black, white or nothing is the part, or the opacity of a"
    " cut-out picture"
)


def add_animate(parser: argparse.ArgumentParser) -> None:
    """All that ``physanimator animate`` takes."""
    parser.description = (
        "Animate the parts of an illustration that masks or query points select. Without a scene, the parts are"
        " held where they are attached and a gentle wind blows."
    )
    _add_picture(parser)
    _add_parts(parser)
    _add_direction(parser)
    _add_files(parser, output=None)
    add_networks(parser, points=True, in_betweens=True)
    _add_data(parser)
    _add_volume(parser)


def add_demo(parser: argparse.ArgumentParser) -> None:
    """All that ``physanimator demo`` takes."""
    parser.description = "Animate the bundled example: hair, cape, ribbon and a plant in the wind."
    _add_files(parser, output="demo.mp4")
    add_networks(parser, points=False, in_betweens=True)
    _add_data(parser)
    _add_volume(parser)


def add_figure(parser: argparse.ArgumentParser) -> None:
    """All that ``physanimator figure`` takes."""
    parser.description = "Draw one of the figures that show what the controls do, from simulations made on the spot."
    parser.add_argument(
        "name",
        metavar="FIGURE",
        choices=("stiffness", "strokes", "collision", "presets"),
        help="stiffness: a ball under a sweep of Young's modulus; strokes: the example under strokes of different"
        " direction and strength; collision: soft balls that meet, with contact and without; presets: a strip of each"
        " preset in one gust",
    )
    parser.add_argument("--output", "-o", metavar="OUT", required=True, help="picture to write (PNG, JPEG, WebP)")
    parser.add_argument("--quiet", "-q", action="store_true", help="no progress bar")


def add_layers(parser: argparse.ArgumentParser) -> None:
    """All that ``physanimator layers`` takes."""
    parser.description = (
        "List the layers of a file from front to back: name, size, place, how each is drawn, whether it would move,"
        " with which preset, and why. Names decide (hair, ribbon, skirt, cape, tail and the like, in English, Japanese"
        " and Chinese) unless --move and --still do."
    )
    parser.add_argument(
        "file",
        metavar="FILE",
        help="PSD, PSB or OpenRaster file (RGB or grey, 8 or 16 bits), folder with one PNG a layer, named from back to"
        " front, or layers.json of See-through; to be written before --move and --still",
    )
    parser.add_argument(
        "--move",
        metavar="NAME",
        action="extend",
        nargs="+",
        default=[],
        help="layers that move whatever their names say; NAME=PRESET also says how",
    )
    parser.add_argument(
        "--still", metavar="NAME", action="extend", nargs="+", default=[], help="layers that stand still"
    )
    parser.add_argument("--groups", action="store_true", help="make one layer of each outermost group")
    parser.add_argument("--save-psd", metavar="OUT", help="write the layers as a .psd or .psb file")
    parser.add_argument(
        "--save-png",
        metavar="OUT_FOLDER",
        help="write each layer as a PNG of the canvas' size; the folder has none yet",
    )
    parser.add_argument("--json", action="store_true", help="print JSON instead of a table")


def add_measure(parser: argparse.ArgumentParser) -> None:
    """All that ``physanimator measure`` takes."""
    parser.description = (
        "Measure a clip against the motion that it should show: the options that made it make the motion again."
    )
    _add_picture(parser)
    _add_parts(parser)
    _add_direction(parser)
    clip = parser.add_argument_group("what is measured")
    clip.add_argument(
        "--clip",
        metavar="CLIP",
        help="video, animated picture or folder with one picture a frame, of the illustration's size (default: what"
        " animate would draw)",
    )
    _add_timing(clip)
    clip.add_argument("--plate", metavar="IMAGE", help="the illustration without its moving parts, if you have it")
    clip.add_argument("--fid", metavar="FILE", help="also the Frechet inception distance; file of Inception's weights")
    clip.add_argument("--reference", metavar="CLIP", help="clip or folder that --fid compares with")
    clip.add_argument("--video-score", metavar="FOLDER", help="also VideoScore's grades; folder of the model")
    clip.add_argument("--description", metavar="TEXT", help="what the clip shows, for --video-score")
    add_networks(parser, points=True, in_betweens=False)
    parser.add_argument("--json", action="store_true", help="print JSON instead of a table")
    parser.add_argument("--quiet", "-q", action="store_true", help="no progress bars")


def _add_picture(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "image",
        metavar="IMAGE",
        help="the illustration (PNG, JPEG, WebP), or layered artwork (.psd, .psb, .ora, a folder of PNG files from back"
        " to front); best written first: where it is missing, the last value of --mask,"
        " --preset or --collider is it, if just one of them has more than one value",
    )


def _add_parts(parser: argparse.ArgumentParser) -> None:
    parts = parser.add_argument_group("what moves (at least one, unless the picture is in layers)")
    parts.add_argument(
        "--mask",
        metavar="MASK",
        action="extend",
        nargs="+",
        default=[],
        help=f"picture of the same proportions: {_MASK}; may be repeated, later parts lie in front",
    )
    parts.add_argument(
        "--points",
        metavar="FILE",
        action="append",
        default=[],
        help="clicks on one part: lines of x,y,label (1 on the part, 0 beside it) or JSON; may be repeated",
    )
    parts.add_argument(
        "--in-front",
        metavar="MASK",
        help="mask of what stands still in front of all parts, such as an arm before hair, read as --mask is; the parts"
        " go on behind it",
    )
    parts.add_argument(
        "--move",
        metavar="LAYER",
        action="extend",
        nargs="+",
        default=[],
        help="names of layers that move, beside those whose names say so (see physanimator layers FILE)",
    )
    parts.add_argument(
        "--still", metavar="LAYER", action="extend", nargs="+", default=[], help="names of layers that stand still"
    )


def _add_direction(parser: argparse.ArgumentParser) -> None:
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
        help="mask of what stands still and parts keep out of, read as --mask is; of layered artwork also the name of a"
        " layer that stands still; implies --contact",
    )
    how.add_argument(
        "--strands",
        action=argparse.BooleanOptionalAction,
        help="slit parts along the lines that are drawn between their strands, so that these swing apart (default: hair"
        " and ribbon; with --scene, as it says)",
    )
    how.add_argument(
        "--spacing", metavar="PX", type=float, help="distance of mesh vertices, at least 2 (default: from the mask)"
    )
    add_physics(parser)


def _add_files(parser: argparse.ArgumentParser, *, output: str | None) -> None:
    drawing = parser.add_argument_group(
        "what is written",
        "A file of the same name is replaced when the new one is complete, unless it is read-only or read by this"
        " command. A folder may hold other files, which stay, and the other results of the command. Frames in it"
        " (frame_0000.png and so on) are replaced only if PhysAnimator wrote every one of them, which its record"
        " .physanimator.json in the folder tells, and nobody changed them since; otherwise the folder is refused before"
        " the work.",
    )
    drawing.add_argument(
        "--output",
        "-o",
        metavar="OUT",
        required=output is None,
        default=output,
        help=".mp4, .webm or .mov (ProRes 4444 for editing programs; both with transparency, of an opaque picture the"
        " moving parts alone), .gif, .webp, .apng, or a folder ending in / for numbered PNG files"
        + (f" (default: {output})" if output else ""),
    )
    _add_timing(drawing)
    drawing.add_argument(
        "--width", metavar="PX", type=int, help="width of what is written (default: the illustration's)"
    )
    drawing.add_argument(
        "--background",
        metavar="WHAT",
        help="what is there where nothing moves. picture: all of the picture, opaque, its transparent places white."
        " A colour (a CSS name, #rgb or #rrggbb): the same on that colour. transparent: all of the picture with its own"
        " transparency; of an opaque picture the moving parts alone. parts: the moving parts alone, on transparency."
        " layers: each layer, or of a flat picture each part, as a sequence of its own, OUT/01 hair/frame_0000.png."
        " (default: a transparent picture keeps its transparency, except in .mp4; of an opaque one parts for .webm"
        " and .mov, else picture)",
    )
    drawing.add_argument(
        "--pixel-art",
        action="store_true",
        help="move whole pixels (or blocks, where each pixel of the art is one) and mix no colours. Folders of PNG"
        " files, .apng, .webp and a .gif of up to 255 colours keep them exactly, videos blur them a little."
        " --width repeats pixels: take a whole multiple",
    )
    drawing.add_argument(
        "--interpolate", metavar="N", type=int, default=1, help="draw every N-th frame, fill in the rest"
    )
    drawing.add_argument(
        "--keyframes-at",
        metavar="N,N,...",
        help="draw the frames of these numbers, from 0, and fill in what is between them; frames before the first and"
        " after the last are drawn as well",
    )
    drawing.add_argument("--plate", metavar="IMAGE", help="the illustration without its moving parts, if you have it")
    drawing.add_argument("--save-sketch", metavar="OUT", help="also write the moving line drawing")
    drawing.add_argument("--save-flow", metavar="OUT", help="also write the optical flow as colours")
    drawing.add_argument(
        "--preview", metavar="OUT", help="also write the animation with meshes, pins and strokes on it"
    )


def _add_timing(group: argparse._ArgumentGroup) -> None:
    group.add_argument("--frames", metavar="N", type=int, help="number of frames (default: 72, or the loop's)")
    group.add_argument(
        "--loop", metavar="SECONDS", type=float, help="make a seamless loop of this length (its first frame moves, too)"
    )
    group.add_argument(
        "--skip", metavar="N", type=int, default=0, help="leave out the first N frames, in which the motion settles in"
    )
    group.add_argument("--fps", metavar="F", type=float, help="frames a second (default: the scene's, or 24)")
    group.add_argument(
        "--max-minutes",
        metavar="MIN",
        type=float,
        default=DEFAULT_MINUTES,
        help="computing time that the simulation may take, as estimated for one core of an ordinary machine; what"
        " would take longer is refused before it begins (default: %(default)g)",
    )


def _add_data(parser: argparse.ArgumentParser) -> None:
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
    data.add_argument(
        "--save-scene",
        metavar="OUT.json",
        help="write the scene, what holds the parts and what they are made of included, to edit it and give it to"
        " --scene",
    )
    data.add_argument(
        "--save-spine",
        metavar="OUT_FOLDER",
        help="write a skeleton for Spine 4.2 and its runtimes: each layer or part a slot, those that move as meshes"
        " with deform keys; images/ for the editor, an atlas with straight alpha for engines",
    )
    data.add_argument(
        "--save-gltf",
        metavar="OUT.glb",
        help="write a glTF scene for 3D programs and engines: each layer or part a textured mesh, moved by morph"
        " targets",
    )
    data.add_argument(
        "--tolerance",
        metavar="PX",
        type=float,
        help="how far --save-spine and --save-gltf may be from the motion (default: 0.25): with more there are fewer"
        " keys and targets",
    )
    data.add_argument(
        "--save-uncovered",
        metavar="OUT.png",
        help="write a mask of what the parts uncover in the whole clip, for an image model that paints it once"
        " (black for layers, behind which all is drawn);"
        " --grow says how far it reaches beyond that (default: 8), --soft-edge how soft its edge is (default: 0)",
    )
    data.add_argument(
        "--save-plate",
        metavar="OUT.png",
        help="write the picture without its moving parts, to paint it over where --save-uncovered is white and give it"
        " back to --plate",
    )
    data.add_argument(
        "--save-vectors",
        metavar="OUT_FOLDER",
        help="write motion vectors as EXR files, one a frame: how far each pixel goes to the next frame and came from"
        " the one before, x right and y up; needs the package OpenEXR",
    )
    data.add_argument(
        "--vector-channels",
        choices=("nuke", "blender"),
        help="of --save-vectors. nuke: forward.u, forward.v, backward.u, backward.v (default). blender: the pass Vector"
        " as Cycles writes it",
    )
    data.add_argument("--save-svg", metavar="OUT.svg", help="write the moving meshes as an SVG that plays in a browser")


def _add_volume(parser: argparse.ArgumentParser) -> None:
    volume = parser.add_mutually_exclusive_group()
    volume.add_argument("--verbose", "-v", action="store_true", help="report sizes and the time of each stage")
    volume.add_argument("--quiet", "-q", action="store_true", help="no progress bars")
