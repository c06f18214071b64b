"""The graphs of the published workflows, described for ``export_workflows.py``."""

from __future__ import annotations

import copy
import json
from dataclasses import dataclass
from typing import Any

__all__ = ["WORKFLOWS", "Column", "Group", "Node", "without_models"]


@dataclass(frozen=True)
class Node:
    """One node of a graph.

    Attributes:
        key: its name in this file.
        type: the node's id.
        title: shown on it; empty for the display name.
        height: at least this [canvas units], to leave room for what it shows.
        values: of its widgets, by name; the only widget of a note has no name here.
        inputs: where its inputs come from: ``{"motion": "simulate.motion"}``.
    """

    key: str
    type: str
    title: str
    height: int
    values: dict[str, Any]
    inputs: dict[str, str]


@dataclass(frozen=True)
class Column:
    """Nodes below each other.

    Attributes:
        width: of each [canvas units].
        nodes: from top to bottom.
    """

    width: int
    nodes: tuple[Node, ...]


@dataclass(frozen=True)
class Group:
    """A titled frame around columns.

    Attributes:
        title: of the frame.
        color: of the frame.
        columns: from left to right.
    """

    title: str
    color: str
    columns: tuple[Column, ...]


BLUE, GREEN, ORANGE, TEAL, PURPLE = "#3f789e", "#5a8f5a", "#b06634", "#3a8f8f", "#8a6fb0"

QUICKSTART_NOTE = """\
## One still picture, moving

**Run** lets a gentle wind move the hair, ribbon, cape and plant of the example, and saves a video of 3 seconds.

**Your own picture:** replace *Example Illustration* by *Load Image*, and give each part that shall move a mask: \
painted in the mask editor, or from *Segment by Points*.

**More or less wind:** *wind_strength* and *wind_angle* in *Automatic Scene*.

**Softer or stiffer:** *preset* in *Body*, or connect a *Material*.

**Draw the wind yourself**, and see it move at once: the workflow *scene_editor*.

Every node has a help page: select it and press the **info** button above it.
"""

ANIMATE_NOTE = """\
## Click on what shall move

**Your own picture:** drop it on the canvas of *Animate Illustration*, then click on what shall move.

**Several parts:** *New part*, or Shift with the click. **Too much is cut:** Alt with the click.

**Run** makes the frames and saves a video.
"""

STEPS_NOTE = """\
## The wind, drawn by hand

Every step of the paper, one node each.

**1** *Segment by Points* cuts the cape out: points with 1 are on it, points with 0 beside it.

**2** Two bodies. The hair's *Material* sways slower than usual.

**3** An *Energy Stroke* blows gusts along its path, a second one pushes like a hand. *Rig Points* hold the hair at \
the head and swing the cape at the shoulder.

**4** *Optical Flow* bends the *sketch* along: this is what a sketch-guided video model wants.

**5** *Interpolate* keeps every 15th frame and draws the others anew.
"""

PINS_NOTE = """\
## Wind in the hair, held by pins

Two *Rig Points* hold the hair: one at the head, and one at the neck that lets go softly (*falloff*).

The *Wind* blows everywhere, in gusts and with eddies; the *Energy Stroke* is a stronger puff that runs along the hair.

Move the pins, and watch them in *Preview Motion*.
"""

CONTACT_NOTE = """\
## Two bodies that touch

A strong wind from the right bends the sunflower into the hair. *Contact* keeps them out of each other: the petals push
the locks aside. Disconnect it to see the difference.

More *friction*: the hair clings. A *collider* mask makes anything in the picture solid.
"""

LOOP_NOTE = """\
## A seamless loop, moved at the root

*Simulate* has *loop* set to 3 seconds: everything that acts is fitted to it, and the video begins where it ends.

The *Rig Point* swings and turns the bow itself; the ribbons follow, overlap and settle.
"""

INPAINT_NOTE = """\
## What the parts uncover, painted by a model

*Render* moves the hair and the plant, and Stable Diffusion paints what they leave behind: fully in the hole, less and \
less in a soft edge around it. Everything else is the illustration to the pixel.

**Model files:** the folder *stable-diffusion-inpainting* (unet, vae, text_encoder, tokenizer, scheduler) in \
`models/diffusers`, from https://huggingface.co/stable-diffusion-v1-5/stable-diffusion-inpainting

**More of the clean plate:** lower *strength*. **More blending:** widen *soft_edge*.

Without the files, set *renderer* to *composite*: holes are then filled with the colours and lines around them.
"""

REPAINT_NOTE = """\
## Frames repainted by Stable Video Diffusion

*Render* draws the moving hair and ribbon itself, and Stable Video Diffusion paints over that: held to the \
animation's motion for the first steps, free afterwards (dual-clock denoising, Time-to-Move). Neither sketches nor \
LVCD are needed.

**Model file:** `svd.safetensors` (9.6 GB, 14 frames) in `models/checkpoints`, from \
https://huggingface.co/stabilityai/stable-video-diffusion-img2vid (Stability AI Community License: free below a yearly \
revenue that it names, read it there). **Memory:** a GPU of 6 GB at 576 x 320, with 16 bits; on a CPU a clip takes \
hours.

**Parts leave the animation's path:** raise *strong* by 0.1. **As stiff as before:** lower it. **What stands still \
changes:** raise *weak*. **To follow lines as well:** connect *Warp Sketch* to *sketches* and choose LVCD's file.

Without the file, set *renderer* to *composite*.
"""

EDITOR_NOTE = """\
## Draw what moves it

Press **Run** once: the *Scene Editor* then knows the bodies and plays every change at once.

**Wind** blows along a drawn line, **repel** and **attract** push and pull. **Pin** holds a spot, **lead** drags it \
along as fast as you draw, **wave** swings it. **Stiffness** paints what bends less.

The button at the right end of the tools opens the editor in the whole window. Select an item to type its numbers.

All that is drawn is one text in the node: it is saved with the workflow and runs without a browser too.
"""

DRAWN = {
    "version": 2,
    "width": 1280,
    "height": 720,
    "strokes": [
        {
            "kind": "wind",
            "path": [[430, 250], [560, 290], [690, 190], [820, 300], [950, 190], [1080, 280]],
            "radius": 190,
            "speed": 720,
            "strength": 2,
            "interval": 0.75,
        },
        {
            "kind": "wind",
            "path": [[470, 540], [590, 470], [700, 580], [820, 490], [900, 560]],
            "radius": 160,
            "speed": 560,
            "strength": 1.8,
            "start": 0.1,
            "interval": 1,
        },
        {
            "kind": "repel",
            "path": [[960, 420], [800, 330]],
            "radius": 110,
            "speed": 160,
            "strength": 1.5,
            "interval": 2,
        },
    ],
    "rig_points": [
        {
            "position": [545, 250],
            "region": {
                "type": "polygon",
                "points": [[480, 90], [600, 90], [606, 300], [600, 372], [636, 436], [620, 470], [480, 360]],
            },
            "motion": {"type": "pinned"},
            "body": 1,
        },
        {
            "position": [612, 480],
            "region": {
                "type": "polygon",
                "points": [[560, 380], [640, 390], [642, 466], [622, 488], [620, 530], [598, 580], [560, 580]],
            },
            "motion": {"type": "pinned"},
            "body": 0,
        },
        {
            "position": [543, 100],
            "region": {
                "type": "polygon",
                "points": [[440, 10], [545, 40], [600, 70], [640, 64], [650, 160], [440, 160]],
            },
            "motion": {"type": "wave", "amplitude": 6, "period": 1.5, "direction": [0, 1]},
            "body": 2,
        },
    ],
}

PAPER_NOTE = """\
## The paper, as a graph

Illustration, query points, mesh, strokes, rig, simulation, flow, sketch, warp, blur, **sketch-guided SVD**, \
interpolation.

**Four model files** are needed, as *Render* and *Interpolate* tell:

- `models/checkpoints/svd.safetensors` from \
https://huggingface.co/stabilityai/stable-video-diffusion-img2vid
- `models/controlnet/lvcd.ckpt` from \
https://huggingface.co/luckyhzt/lvcd_pretrained_models
- `models/checkpoints/model.ckpt` and `models/controlnet/sketch_encoder.ckpt` from \
https://huggingface.co/Doubiiu/ToonCrafter

Without them, set *renderer* in *Render* to *composite*, and *backend* in *Interpolate* to *motion*.

**35 frames** are three segments of the video model: 15, then 10 with each further segment. Other lengths work too.

Settings are explained on the help pages of both: select one and press **?**.
"""

HEAD = {
    "position": "[[470, 130]]",
    "region": "polygon",
    "region.points": "[[340, 20], [600, 20], [600, 330], [340, 330]]",
    "body": 0,
}

Renderer = tuple[dict[str, Any], dict[str, str]]

_COMPOSITE: Renderer = ({}, {})
_SKETCH_GUIDED: Renderer = ({"renderer": "sketch-guided SVD"}, {"renderer.sketches": "warp.sketches"})
_PAINTED = {
    "renderer": "soft inpainting",
    "renderer.prompt": "anime illustration, a girl outdoors, blue sky, clean lines, flat colours",
    "renderer.negative_prompt": "blurry, photographic, text",
    "renderer.strength": 0.75,
}
_REPAINTED: Renderer = ({"renderer": "animation-guided SVD", "renderer.svd_model": "svd.safetensors"}, {})
_INPAINTED: Renderer = (_PAINTED, {})

PICKED = {
    "version": 2,
    "width": 1280,
    "height": 720,
    "query_points": [
        *({"x": x, "y": y} for x, y in ((700, 300), (560, 215), (600, 330), (640, 250))),
        *({"x": x, "y": y, "part": 1} for x, y in ((620, 60), (500, 80), (545, 100), (610, 110))),
        *({"x": x, "y": y, "part": 2} for x, y in ((680, 540), (640, 480), (700, 590))),
        *({"x": x, "y": y, "positive": False, "part": 2} for x, y in ((470, 420), (560, 400), (600, 480), (760, 640))),
    ],
    "bodies": [{"material": {"preset": name}} for name in ("hair", "ribbon", "cloth")],
}

CAPE_POINTS = """\
[[680, 540, 1], [640, 480, 1], [700, 590, 1],
 [650, 612, 1], [790, 568, 1], [720, 610, 1],
 [470, 420, 0], [560, 400, 0], [600, 480, 0],
 [597, 475, 0], [612, 440, 0], [545, 478, 0],
 [760, 640, 0], [700, 470, 0]]"""


def core(key: str, node_type: str, height: int = 0, /, title: str = "", values: Any = None, **inputs: str) -> Node:
    """A node of the host."""
    return Node(key, node_type, title, height, values or {}, inputs)


def ours(key: str, node_type: str, height: int = 0, /, title: str = "", values: Any = None, **inputs: str) -> Node:
    """A node of this pack."""
    return Node(key, f"PhysAnimator_{node_type}", title, height, values or {}, inputs)


def animate_illustration() -> tuple[Group, ...]:
    """Hair, bow and cape of the bundled illustration, picked by clicks in the one node that goes the whole way."""
    picked = {"points": json.dumps(PICKED, separators=(",", ":"))}
    nodes = (
        ours("animate", "AnimateIllustration", 860, values=picked),
        core("video", "CreateVideo", images="animate.frames", fps="animate.frame_rate"),
        core("save", "SaveVideo", 0, "", {"filename_prefix": "PhysAnimator/animate"}, video="video.VIDEO"),
    )
    note = core("note", "MarkdownNote", 300, "Start here", {"": ANIMATE_NOTE})
    return (Group("From a picture to a video", PURPLE, (Column(300, (note,)), Column(680, nodes))),)


def quickstart() -> tuple[Group, ...]:
    """From the bundled illustration to a saved video, with the automatic scene."""
    return (
        _illustration(380, core("note", "MarkdownNote", 400, "Start here", {"": QUICKSTART_NOTE})),
        _bodies(
            ("cape", "cloth", "top"), ("hair", "hair", "left"), ("ribbon", "ribbon", "left"), ("plant", "leaf", "auto")
        ),
        Group(
            "3 · Physics simulation",
            ORANGE,
            (_simulated(420, ours("scene", "AutomaticScene", bodies="body_3.bodies")),),
        ),
        _video("quickstart", 520, "render.frames"),
    )


def every_step() -> tuple[Group, ...]:
    """Each step of the paper: query points, strokes and rig points, flow and sketch, keyframes and in-betweens."""
    scene = ours(
        "scene",
        "Scene",
        values={"gravity_y": 0.1},
        bodies="body_hair.bodies",
        strokes="hand.strokes",
        rig_points="shoulder.rig_points",
    )
    segment = ours("segment", "SegmentByPoints", 720, values={"points": CAPE_POINTS}, image="example.image")
    interpolate = ours(
        "interpolate", "Interpolate", images="render.frames", motion="simulate.motion", image="example.image"
    )
    return (
        _illustration(340, core("note", "MarkdownNote", 450, "Every step", {"": STEPS_NOTE}), segment),
        _cape_and_hair(),
        Group("3 · Strokes, rig points, simulation", ORANGE, (_drawn(), _simulated(400, scene, {"frames": 61}))),
        _sketches(),
        _video("every_step", 420, "interpolate.frames", interpolate),
    )


def physanimator_paper() -> tuple[Group, ...]:
    """The paper's pipeline, with its renderer."""
    scene = ours(
        "scene",
        "Scene",
        values={"gravity_y": 0.1},
        bodies="body_hair.bodies",
        strokes="hand.strokes",
        rig_points="shoulder.rig_points",
    )
    segment = ours("segment", "SegmentByPoints", 440, values={"points": CAPE_POINTS}, image="example.image")
    # The motion is for those who choose the backend that needs no model files.
    led = {"motion": "simulate.motion", "backend.sketches": "warp.sketches", "image": "example.image"}
    drawn = ours("interpolate", "Interpolate", values={"backend": "tooncrafter"}, images="render.frames", **led)
    video = _video("physanimator_paper", 420, "interpolate.frames", drawn, renderer=_SKETCH_GUIDED)
    return (
        _illustration(340, core("note", "MarkdownNote", 520, "The paper", {"": PAPER_NOTE}), segment),
        _cape_and_hair(),
        Group("3 · Strokes, rig points, simulation", ORANGE, (_drawn(), _simulated(400, scene, {"frames": 35}))),
        _sketches(),
        video,
    )


def wind_and_pins() -> tuple[Group, ...]:
    """Hair held by two pins in a wind field and under a drawn puff."""
    neck = {"position": "[[560, 340]]", "region.radius": 40, "falloff": 60, "body": 0}
    puff = {
        "path": "[[430, 380], [560, 320], [690, 440], [820, 320], [950, 420]]",
        "radius": 170,
        "speed": 610,
        "strength": 1.6,
    }
    drawn = (
        ours("wind", "Wind", values={"strength": 1.5, "angle": 30, "gust": 0.7, "turbulence": 0.7}),
        ours("puff", "EnergyStroke", 0, "Energy Stroke: a puff", puff),
        ours("head", "RigPoint", 0, "Rig Point: the head", HEAD),
        ours("neck", "RigPoint", 0, "Rig Point: the neck, soft", neck, rig_points="head.rig_points"),
    )
    acting = {"strokes": "puff.strokes", "rig_points": "neck.rig_points", "wind": "wind.wind"}
    scene = ours("scene", "Scene", bodies="body_0.bodies", **acting)
    return (
        _illustration(380, core("note", "MarkdownNote", 300, "Wind and pins", {"": PINS_NOTE})),
        _bodies(("hair", "hair", "left")),
        Group("3 · Wind, pins, simulation", ORANGE, (Column(330, drawn), _simulated(420, scene))),
        _video("wind_and_pins", 520, "render.frames"),
    )


def contact() -> tuple[Group, ...]:
    """A plant that the wind bends into the hair, and that cannot pass through it."""
    touch = ours("contact", "Contact", values={"friction": 0.2})
    gale = ours("gale", "Wind", values={"strength": 1.5, "angle": 180, "gust": 0.8, "turbulence": 0.4})
    acting = {"wind": "gale.wind", "contact": "contact.contact"}
    scene = ours("scene", "AutomaticScene", bodies="body_1.bodies", **acting)
    return (
        _illustration(380, core("note", "MarkdownNote", 300, "Contact", {"": CONTACT_NOTE})),
        _bodies(("hair", "hair", "left"), ("plant", "leaf", "auto")),
        Group("3 · Contact and simulation", ORANGE, (Column(330, (gale, touch)), _simulated(420, scene))),
        _video("contact", 520, "render.frames"),
    )


def scene_editor() -> tuple[Group, ...]:
    """Wind, a push, pins and a swinging bow, drawn in the editor on the picture itself."""
    inputs = {"bodies": "body_2.bodies", "image": "example.image"}
    drawn = {"scene": json.dumps(DRAWN, separators=(",", ":"))}
    return (
        _illustration(380, core("note", "MarkdownNote", 440, "Scene editor", {"": EDITOR_NOTE})),
        _bodies(("cape", "cloth", "top"), ("hair", "hair", "left"), ("ribbon", "ribbon", "left")),
        Group(
            "3 · Draw what moves them",
            ORANGE,
            (
                Column(
                    900,
                    (
                        ours("scene", "SceneEditor", 680, values=drawn, **inputs),
                        ours("simulate", "Simulate", scene="scene.scene"),
                    ),
                ),
            ),
        ),
        _video("scene_editor", 520, "render.frames"),
    )


def seamless_loop() -> tuple[Group, ...]:
    """A bow that swings and turns, whose ribbons follow, as a loop without a seam."""
    bow = {
        "position": "[[543, 100]]",
        "region": "polygon",
        "region.points": "[[440, 10], [545, 40], [600, 70], [640, 64], [650, 160], [440, 160]]",
        "motion": "wave",
        "motion.amplitude": 8,
        "motion.period": 1.5,
        "turn": "swing",
        "turn.amplitude": 8,
        "turn.period": 1.5,
        "body": 0,
    }
    root = ours("root", "RigPoint", 0, "Rig Point: the bow swings and turns", bow)
    breeze = ours("breeze", "Wind", values={"strength": 0.5, "turbulence": 0.5})
    acting = {"rig_points": "root.rig_points", "wind": "breeze.wind"}
    scene = ours("scene", "Scene", bodies="body_0.bodies", **acting)
    return (
        _illustration(380, core("note", "MarkdownNote", 300, "Seamless loop", {"": LOOP_NOTE})),
        _bodies(("ribbon", "ribbon", "left")),
        Group(
            "3 · Root motion and loop",
            ORANGE,
            (Column(330, (root, breeze)), _simulated(420, scene, {"loop": 3.0, "frames": 72})),
        ),
        _video("seamless_loop", 520, "render.frames"),
    )


def soft_inpaint() -> tuple[Group, ...]:
    """The quickstart's wind, with holes painted by Stable Diffusion."""
    return (
        _illustration(380, core("note", "MarkdownNote", 420, "Soft inpainting", {"": INPAINT_NOTE})),
        _bodies(("hair", "hair", "left"), ("plant", "leaf", "auto")),
        Group(
            "3 · Physics simulation",
            ORANGE,
            (_simulated(420, ours("scene", "AutomaticScene", bodies="body_1.bodies"), {"frames": 48}),),
        ),
        _video("soft_inpaint", 520, "render.frames", renderer=_INPAINTED),
    )


def render_from_animation() -> tuple[Group, ...]:
    """The quickstart's wind, with frames that Stable Video Diffusion paints after composite's.

    Few a second, as it was trained for: then the same work shows more of the motion.
    """
    scene = ours("scene", "AutomaticScene", 0, "", {"frame_rate": 12.0}, bodies="body_1.bodies")
    return (
        _illustration(380, core("note", "MarkdownNote", 420, "Repainted frames", {"": REPAINT_NOTE})),
        _bodies(("hair", "hair", "left"), ("ribbon", "ribbon", "left")),
        Group("3 · Physics simulation", ORANGE, (_simulated(420, scene, {"frames": 44}),)),
        _video("render_from_animation", 520, "render.frames", renderer=_REPAINTED),
    )


def _illustration(width: int, note: Node, *more: Node) -> Group:
    nodes = (note, ours("example", "ExampleIllustration", 370), *more)
    return Group("1 · Illustration and masks", BLUE, (Column(width, nodes),))


def _bodies(*parts: tuple[str, str, str]) -> Group:
    nodes: list[Node] = []
    for layer, (part, preset, attach) in enumerate(parts):
        before = {"bodies": f"body_{layer - 1}.bodies"} if layer else {}
        values = {"preset": preset, "layer": layer, "attach": attach}
        nodes += [
            _mesh(part, f"example.{part}"),
            ours(f"body_{layer}", "Body", 0, f"Body: {part}", values, mesh=f"mesh_{part}.mesh", **before),
        ]
    columns = [Column(300, tuple(nodes[k : k + 4])) for k in range(0, len(nodes), 4)]
    return Group("2 · Deformable bodies", GREEN, tuple(columns))


def _cape_and_hair() -> Group:
    hair = {"mesh": "mesh_hair.mesh", "bodies": "body_cape.bodies", "material": "material.material"}
    nodes = (
        _mesh("cape", "segment.mask"),
        ours("body_cape", "Body", 0, "Body: cape", {"preset": "cloth"}, mesh="mesh_cape.mesh"),
        _mesh("hair", "example.hair"),
        ours("material", "Material", values={"preset.sway_frequency": 0.55}),
        ours("body_hair", "Body", 0, "Body: hair", {"layer": 1}, **hair),
    )
    return Group("2 · Deformable bodies", GREEN, (Column(300, nodes),))


def _mesh(part: str, mask: str) -> Node:
    return ours(f"mesh_{part}", "MaskToMesh", 340, f"Mask to Mesh: {part}", mask=mask, image="example.image")


def _drawn() -> Column:
    gusts = {
        "path": "[[120, 330], [560, 300], [1000, 240], [1280, 260]]",
        "radius": 320,
        "speed": 800,
        "strength": 2.5,
        "interval": 1.2,
    }
    hand = {
        "kind": "repel",
        "path": "[[900, 470], [720, 420]]",
        "radius": 160,
        "speed": 150,
        "strength": 3,
        "start": 0.5,
        "interval": 2.5,
    }
    head = HEAD | {"body": 1}
    shoulder = {
        "position": "[[640, 450]]",
        "region.radius": 45,
        "motion": "wave",
        "motion.amplitude": 12,
        "motion.period": 1.5,
        "body": 0,
    }
    return Column(
        330,
        (
            ours("gusts", "EnergyStroke", 0, "Energy Stroke: gusts", gusts),
            ours("hand", "EnergyStroke", 0, "Energy Stroke: a hand", hand, strokes="gusts.strokes"),
            ours("head", "RigPoint", 0, "Rig Point: the head holds the hair", head),
            ours("shoulder", "RigPoint", 0, "Rig Point: the shoulder swings", shoulder, rig_points="head.rig_points"),
        ),
    )


def _simulated(width: int, scene: Node, values: dict[str, Any] | None = None) -> Column:
    shown = {"image": "example.image", "motion": "simulate.motion", "scene": "scene.scene"}
    simulate = ours("simulate", "Simulate", values=values, scene="scene.scene")
    return Column(width, (scene, simulate, ours("preview", "PreviewMotion", 430, **shown)))


def _sketches() -> Group:
    saved = {"filename_prefix": "PhysAnimator/sketch", "fps": 24, "quality": 80, "lossless": False, "method": "fastest"}
    nodes = (
        ours("flow", "OpticalFlow", motion="simulate.motion"),
        ours("preview_flow", "PreviewFlow", 370, flow="flow.flow"),
        ours("sketch", "ExtractSketch", image="example.image"),
        ours("warp", "WarpSketch", sketch="sketch.sketch", flow="flow.flow"),
        core("save_sketch", "SaveAnimatedWEBP", 370, "Sketches", saved, images="warp.sketches"),
    )
    return Group("4 · Flow and sketch", TEAL, (Column(370, nodes),))


def _video(name: str, width: int, frames: str, *between: Node, renderer: Renderer = _COMPOSITE) -> Group:
    values, inputs = renderer
    nodes = (
        ours("render", "Render", values=values, image="example.image", motion="simulate.motion", **inputs),
        *between,
        core("video", "CreateVideo", images=frames, fps="simulate.frame_rate"),
        core("save", "SaveVideo", 480, "", {"filename_prefix": f"PhysAnimator/{name}"}, video="video.VIDEO"),
    )
    number = 5 if between else 4
    return Group(f"{number} · Frames and video", PURPLE, (Column(width, nodes),))


WORKFLOWS = {
    "animate_illustration": animate_illustration,
    "quickstart": quickstart,
    "every_step": every_step,
    "physanimator_paper": physanimator_paper,
    "wind_and_pins": wind_and_pins,
    "contact": contact,
    "seamless_loop": seamless_loop,
    "scene_editor": scene_editor,
    "soft_inpaint": soft_inpaint,
    "render_from_animation": render_from_animation,
}


def without_models(api: dict[str, Any]) -> dict[str, Any]:
    """The workflow with those choices that need no model files."""
    changed = copy.deepcopy(api)
    for kind, choice, plain in (
        ("SegmentByPoints", "backend", "grabcut"),
        ("ExtractSketch", "extractor", "difference of Gaussians"),
        ("Render", "renderer", "composite"),
        ("Interpolate", "backend", "motion"),
    ):
        for node in changed.values():
            if node["class_type"] == f"PhysAnimator_{kind}":
                kept = {name: value for name, value in node["inputs"].items() if not name.startswith(f"{choice}.")}
                node["inputs"] = kept | {choice: plain}
    return changed
