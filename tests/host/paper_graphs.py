"""The published workflow that follows the paper to the letter."""

from __future__ import annotations

from graphs import BLUE, GREEN, ORANGE, PURPLE, TEAL, Column, Group, Node, core, ours

__all__ = ["PAPER_WORKFLOWS", "STRICT"]

STRICT = "paper_strict"

_NOTE = """\
## The paper, to the letter

*physanimator_paper* takes what works without further files or looks better; this graph takes what the paper says.

- **Segment Anything** cuts cape and hair out at the query points
- meshes with **boundary points at equal distances** (*uniform*), and not fitted to the picture's outlines
- materials by the **Lame parameters** alone: no damping, no stretch limit, no stiffer roots
- **semi-implicit Euler with a step of 0.001 s**, strokes as forces, and bodies that sag under gravity
- the **drawing network of Chan et al.**, its lines as they come
- **the paper's warp weight**, and blurred sketches
- video model without *keep_still_parts*
- **every 15th frame** a keyframe, **control scale 0.1**

**Model files** beside the four of *physanimator_paper*:

- the folder `models/sams/sam2.1-hiera-base-plus` from \
https://huggingface.co/facebook/sam2.1-hiera-base-plus
- `models/controlnet/sk_model.pth` from \
https://huggingface.co/lllyasviel/Annotators

The authors have not published their own weights: LVCD's and ToonCrafter's stand in.

Without model files, set *backend* in *Segment by Points* to *grabcut*, *extractor* to *difference of Gaussians*, \
*renderer* to *composite*, and *backend* in *Interpolate* to *motion*.

**Differences from the paper** that no setting removes are listed in `workflows/differences_from_the_paper.md`.
"""

_POINTS = """\
[[680, 540, 1, 0], [640, 480, 1, 0], [700, 590, 1, 0],
 [650, 612, 1, 0], [790, 568, 1, 0], [720, 610, 1, 0],
 [470, 420, 0, 0], [560, 400, 0, 0], [600, 480, 0, 0],
 [597, 475, 0, 0], [612, 440, 0, 0], [545, 478, 0, 0],
 [760, 640, 0, 0], [700, 470, 0, 0],
 [600, 200, 1, 1], [720, 260, 1, 1], [840, 300, 1, 1],
 [880, 345, 1, 1], [560, 150, 1, 1], [380, 130, 1, 1],
 [470, 240, 0, 1], [640, 480, 0, 1], [900, 110, 0, 1],
 [872, 170, 0, 1], [940, 310, 0, 1], [880, 420, 0, 1],
 [510, 350, 0, 1], [1000, 310, 0, 1], [860, 265, 0, 1]]"""

_ELASTIC = {"preset": "lame", "preset.damping": 0.0, "preset.stretch_limit": 0.0}
_MESHED = {"spacing": 16.0, "uniform": True}


def paper_strict() -> tuple[Group, ...]:
    """Every step as the paper has it, with the weights that are public."""
    segment = {"points": _POINTS, "backend": "segment anything", "backend.sam_model": "sam2.1-hiera-base-plus/"}
    cut = ours("segment", "SegmentByPoints", 720, "", segment, image="example.image")
    note = core("note", "MarkdownNote", 640, "The paper, to the letter", {"": _NOTE})
    example = ours("example", "ExampleIllustration", 370)
    return (
        Group("1 · Illustration and query points", BLUE, (Column(380, (note, example)), Column(380, (cut,)))),
        Group("2 · Deformable bodies", GREEN, (Column(300, _bodies()),)),
        Group("3 · Strokes, rigging points, simulation", ORANGE, (Column(330, _acting()), Column(400, _simulated()))),
        Group("4 · Flow and sketch", TEAL, (Column(370, _sketches()),)),
        Group("5 · Sketch-guided rendering, complementary dynamics", PURPLE, (Column(420, _rendered()),)),
    )  # fmt: skip


def _bodies() -> tuple[Node, ...]:
    cape, hair = (
        _ELASTIC | {"preset.mu": 2.0, "preset.lambda": 3.0},
        _ELASTIC | {"preset.mu": 2.0, "preset.lambda": 3.0},
    )
    return (
        ours("mesh_cape", "MaskToMesh", 340, "Mask to Mesh: cape", _MESHED, mask="segment.mask"),
        ours("cloth", "Material", 0, "Material: cape", cape),
        ours("body_cape", "Body", 0, "Body: cape", mesh="mesh_cape.mesh", material="cloth.material"),
        ours("mesh_hair", "MaskToMesh", 340, "Mask to Mesh: hair", _MESHED | {"mask_index": 1}, mask="segment.mask"),
        ours("locks", "Material", 0, "Material: hair", hair),
        ours(
            "body_hair",
            "Body",
            0,
            "Body: hair",
            {"layer": 1},
            mesh="mesh_hair.mesh",
            bodies="body_cape.bodies",
            material="locks.material",
        ),
    )


def _acting() -> tuple[Node, ...]:
    gusts = {"path": "[[120, 330], [560, 300], [1000, 240], [1280, 260]]", "radius": 320, "speed": 800, "strength": 2.5}
    hand = {"kind": "repel", "path": "[[900, 470], [720, 420]]", "radius": 160, "speed": 150, "strength": 3}
    head = {"position": "[[470, 130]]", "region": "polygon", "body": 1}
    head |= {"region.points": "[[340, 20], [600, 20], [600, 330], [340, 330]]"}
    shoulder = {"position": "[[640, 450]]", "region.radius": 45, "body": 0}
    shoulder |= {"motion": "wave", "motion.amplitude": 12, "motion.period": 1.5}
    return (
        ours("gusts", "EnergyStroke", 0, "Energy Stroke: wind", gusts | {"interval": 1.2}),
        ours("hand", "EnergyStroke", 0, "Energy Stroke: repel", hand | {"start": 0.5}, strokes="gusts.strokes"),
        ours("head", "RigPoint", 0, "Rigging point: the head holds the hair", head),
        ours("shoulder", "RigPoint", 0, "Rigging point: the shoulder waves", shoulder, rig_points="head.rig_points"),
    )


def _simulated() -> tuple[Node, ...]:
    acting = {"bodies": "body_hair.bodies", "strokes": "hand.strokes", "rig_points": "shoulder.rig_points"}
    step = {"frames": 46, "time_step": 0.001, "strokes_as": "force", "sag": True}
    shown = {"image": "example.image", "motion": "simulate.motion", "scene": "scene.scene"}
    return (
        ours("scene", "Scene", **acting),
        ours("simulate", "Simulate", 0, "", step, scene="scene.scene"),
        ours("preview", "PreviewMotion", 430, **shown),
    )


def _sketches() -> tuple[Node, ...]:
    drawn = {"extractor": "drawing network", "extractor.model": "sk_model.pth", "threshold": 0.001, "smallest_speck": 0}
    saved = {"filename_prefix": "PhysAnimator/sketch", "fps": 24, "quality": 80, "lossless": False, "method": "fastest"}
    return (
        ours("flow", "OpticalFlow", motion="simulate.motion"),
        ours("preview_flow", "PreviewFlow", 370, flow="flow.flow"),
        ours("sketch", "ExtractSketch", 0, "", drawn, image="example.image"),
        ours("warp", "WarpSketch", 0, "", {"mode": "paper"}, sketch="sketch.sketch", flow="flow.flow"),
        core("save_sketch", "SaveAnimatedWEBP", 370, "Sketches", saved, images="warp.sketches"),
    )


def _rendered() -> tuple[Node, ...]:
    svd = {"renderer": "sketch-guided SVD", "renderer.keep_still_parts": False}
    between = {"backend": "tooncrafter", "every": 15, "backend.control_scale": 0.1}
    led = {"motion": "simulate.motion", "backend.sketches": "warp.sketches"}
    given = {"motion": "simulate.motion", "renderer.sketches": "warp.sketches"}
    return (
        ours("render", "Render", 0, "", svd, image="example.image", **given),
        ours("interpolate", "Interpolate", 0, "", between, images="render.frames", **led),
        core("video", "CreateVideo", images="interpolate.frames", fps="simulate.frame_rate"),
        core("save", "SaveVideo", 480, "", {"filename_prefix": f"PhysAnimator/{STRICT}"}, video="video.VIDEO"),
    )


PAPER_WORKFLOWS = {STRICT: paper_strict}
