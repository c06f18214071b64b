"""Published workflows that compare: the paper's figures on controllability, and a clip that is measured."""

from __future__ import annotations

import json
from typing import Any

from graphs import BLUE, GREEN, ORANGE, PURPLE, TEAL, Column, Group, Node, core, ours

__all__ = ["SHOWCASE_WORKFLOWS"]

_STROKES_NOTE = """\
## One stroke, two directions, two strengths

The paper's figure on energy strokes: the same hair, four times, each under a stroke of its own. Above: to the left. \
Below: upwards. Left: *strength* 1. Right: *strength* 3.

Change *path*, *strength*, *radius* or *kind* of one stroke and compare.

As one picture: `physanimator figure strokes --output strokes.png`
"""

_STIFFNESS_NOTE = """\
## One gust, four stiffnesses

The paper's figure on material: the same hair in the same gust, with Young's modulus 5, 20, 80 and 320. The \
stiffer it is, the better it keeps its shape.

Change *youngs_modulus* in one *Material*, or its *damping* or *density*, and compare.

The paper's ball: `physanimator figure stiffness --output stiffness.png`
"""

_MEASURED_NOTE = """\
## Painted material, a scene from elsewhere, and how good the frames are

**Paint Material** makes the hair stiff at the head and soft at the tips, as a mask says: white is *white* times as \
stiff. Paint a mask of your own in the mask editor, or make one of gradients as here.

**Scene from JSON** takes what the command line, the scene editor or your own program wrote: its strokes, wind and rig \
points act on the bodies that are connected.

**Metrics** measures the frames against the motion that they should show: does colour flicker on the bodies, does the \
rest stay still, do lines follow the sketches? Connect the frames of a video model in place of *Render*'s and compare \
the numbers; the node's help says what each means.
"""

_HAIR_HELD = {
    "position": "[[470, 130]]",
    "region": "polygon",
    "region.points": "[[340, 20], [600, 20], [600, 330], [340, 330]]",
    "body": 0,
}
_LEFT, _UP = "[[1180, 250], [420, 250]]", "[[800, 680], [800, 60]]"
_HALF = {"upscale_method": "area", "width": 640, "height": 360}
_FRAMES = {"frames": 37}

_DOCUMENT = {
    "version": 2,
    "width": 1280,
    "height": 720,
    "strokes": [
        {
            "kind": "wind",
            "path": [[620, 330], [820, 190], [950, 330], [1080, 240]],
            "radius": 220,
            "speed": 700,
            "strength": 3,
            "interval": 0.5,
        }
    ],
    "rig_points": [
        {
            "position": [545, 250],
            "region": {
                "type": "polygon",
                "points": [[480, 90], [600, 90], [606, 300], [600, 372], [636, 436], [620, 470], [480, 360]],
            },
            "motion": {"type": "pinned"},
            "body": 0,
        }
    ],
}


def figure_strokes() -> tuple[Group, ...]:
    """The same hair under strokes of two directions and two strengths, side by side."""
    head = ours("head", "RigPoint", 0, "Rig Point: the head", _HAIR_HELD)
    cases = [(_LEFT, 1), (_LEFT, 3), (_UP, 1), (_UP, 3)]
    drawn: list[Node] = []
    for number, (path, strength) in enumerate(cases):
        way = "to the left" if path == _LEFT else "upwards"
        stroke = {"path": path, "strength": strength, "radius": 260, "speed": 900, "interval": 0.2}
        acting = {"bodies": "body.bodies", "rig_points": "head.rig_points", "strokes": f"stroke_{number}.strokes"}
        drawn += [
            ours(f"stroke_{number}", "EnergyStroke", 0, f"{way}, strength {strength}", stroke),
            ours(f"scene_{number}", "Scene", **acting),
        ]
    body = (_mesh(), ours("body", "Body", mesh="mesh.mesh"), head)
    return (
        _illustration(_STROKES_NOTE),
        Group("2 · One body", GREEN, (Column(300, body),)),
        Group("3 · Four strokes", ORANGE, (Column(330, tuple(drawn[:4])), Column(330, tuple(drawn[4:])))),
        *_compared("figure_strokes", 4),
    )


def figure_stiffness() -> tuple[Group, ...]:
    """The same hair in the same gust at four stiffnesses, side by side."""
    gust = {"path": _UP, "strength": 2.5, "radius": 260, "speed": 900, "interval": 0.2}
    made: list[Node] = []
    for number, modulus in enumerate((5, 20, 80, 320)):
        material = {"preset": "custom", "preset.youngs_modulus": modulus}
        acting = {"strokes": "gust.strokes", "rig_points": "head.rig_points", "bodies": f"body_{number}.bodies"}
        made += [
            ours(f"material_{number}", "Material", 0, f"Young's modulus {modulus}", material),
            ours(f"body_{number}", "Body", mesh="mesh.mesh", material=f"material_{number}.material"),
            ours(f"scene_{number}", "Scene", **acting),
        ]
    head = ours("head", "RigPoint", 0, "Rig Point: the head", _HAIR_HELD)
    acting_on_all = (_mesh(), ours("gust", "EnergyStroke", 0, "Energy Stroke: a gust", gust), head)
    return (
        _illustration(_STIFFNESS_NOTE),
        Group("2 · One shape, one gust", GREEN, (Column(300, acting_on_all),)),
        Group("3 · Four materials", ORANGE, (Column(300, tuple(made[:6])), Column(300, tuple(made[6:])))),
        *_compared("figure_stiffness", 4),
    )


def paint_and_measure() -> tuple[Group, ...]:
    """Hair that is stiff at the head, moved by a document, and measured."""
    black, white = {"value": 0, "width": 1280, "height": 720}, {"value": 1, "width": 420, "height": 720}
    joined = {"x": 400, "operation": "add"}
    painted = (
        _mesh(),
        core("dark", "SolidMask", 0, "All of the picture: black", black),
        core("light", "SolidMask", 0, "At the head: white", white),
        core("faded", "FeatherMask", 0, "", {"right": 260}, mask="light.MASK"),
        core("mask", "MaskComposite", 0, "", joined, destination="dark.MASK", source="faded.MASK"),
        ours("paint", "PaintMaterial", 0, "", {"white": 6.0}, mesh="mesh.mesh", stiffness="mask.MASK"),
        ours("body", "Body", mesh="mesh.mesh", material="paint.material"),
    )
    shown = {"image": "example.image", "motion": "simulate.motion", "scene": "scene.scene"}
    scene = {"scene": json.dumps(_DOCUMENT, indent=1)}
    simulated = (
        ours("scene", "SceneFromJSON", 420, "", scene, bodies="body.bodies"),
        ours("simulate", "Simulate", 0, "", {"frames": 49}, scene="scene.scene"),
        ours("preview", "PreviewMotion", 430, **shown),
    )
    sketched = (
        ours("flow", "OpticalFlow", motion="simulate.motion"),
        ours("sketch", "ExtractSketch", image="example.image"),
        ours("warp", "WarpSketch", sketch="sketch.sketch", flow="flow.flow"),
    )
    measured = {"images": "render.frames", "motion": "simulate.motion", "drawing": "example.image"}
    rendered = (
        ours("render", "Render", image="example.image", motion="simulate.motion"),
        ours("metrics", "Metrics", sketches="warp.sketches", **measured),
        core("report", "PreviewAny", 260, "How good the frames are", {}, source="metrics.report"),
        *_saved("paint_and_measure", "render.frames", "simulate.frame_rate"),
    )
    return (
        _illustration(_MEASURED_NOTE),
        Group("2 · Painted material", GREEN, (Column(300, painted[:3]), Column(300, painted[3:]))),
        Group("3 · Scene from JSON", ORANGE, (Column(420, simulated),)),
        Group("4 · Sketches", TEAL, (Column(340, sketched),)),
        Group("5 · Frames, measured", PURPLE, (Column(520, rendered),)),
    )


def _illustration(note: str) -> Group:
    written = core("note", "MarkdownNote", 420, "Start here", {"": note})
    return Group(
        "1 · Illustration and masks", BLUE, (Column(380, (written, ours("example", "ExampleIllustration", 370))),)
    )


def _mesh() -> Node:
    return ours("mesh", "MaskToMesh", 340, "Mask to Mesh: hair", mask="example.hair", image="example.image")


def _compared(name: str, first: int) -> tuple[Group, Group]:
    """Four scenes simulated, drawn at half the size, and joined to one picture of two rows."""
    columns = []
    for number in range(4):
        drawn = {"image": "example.image", "motion": f"simulate_{number}.motion"}
        columns += [
            ours(f"simulate_{number}", "Simulate", 0, "", _FRAMES, scene=f"scene_{number}.scene"),
            ours(f"render_{number}", "Render", **drawn),
            core(f"half_{number}", "ImageScale", 0, "", _HALF, image=f"render_{number}.frames"),
        ]
    joined = (
        _joined("above", "half_0", "half_1", "right"),
        _joined("below", "half_2", "half_3", "right"),
        _joined("all", "above", "below", "down"),
        *_saved(name, "all.IMAGE", "simulate_0.frame_rate"),
    )
    return (
        Group(f"{first} · Four clips", TEAL, (Column(330, tuple(columns[:6])), Column(330, tuple(columns[6:])))),
        Group(f"{first + 1} · Side by side", PURPLE, (Column(420, joined),)),
    )


def _joined(key: str, one: str, other: str, direction: str) -> Node:
    return core(key, "ImageStitch", 0, "", {"direction": direction}, image1=f"{one}.IMAGE", image2=f"{other}.IMAGE")


def _saved(name: str, frames: str, rate: str) -> tuple[Node, Node]:
    values: dict[str, Any] = {"filename_prefix": f"PhysAnimator/{name}"}
    return (
        core("video", "CreateVideo", images=frames, fps=rate),
        core("save", "SaveVideo", 480, "", values, video="video.VIDEO"),
    )


SHOWCASE_WORKFLOWS = {
    "figure_strokes": figure_strokes,
    "figure_stiffness": figure_stiffness,
    "paint_and_measure": paint_and_measure,
}
