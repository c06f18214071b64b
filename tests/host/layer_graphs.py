"""The published workflows that move illustrations in layers."""

from __future__ import annotations

from typing import Any

from graphs import BLUE, GREEN, ORANGE, PURPLE, TEAL, Column, Group, Node, core, ours

__all__ = ["LAYER_WORKFLOWS", "SEE_THROUGH"]

SEE_THROUGH = "see_through"

_LAYERS_NOTE = """\
## A picture in layers moves without a guess

**Run** moves the example's hair, ribbon, cape, skirt and plant. Face, collar, body and arms stand still between them, \
and what comes to light behind is drawn: no clean plate, no masks.

**Your own file:** a PSD from Photoshop, Clip Studio Paint or Live2D work, an .ora from Krita, or a folder of PNG \
files. Press the button in *Load Layers*, or drop the file on it.

**What moves** is told by the names of the layers, in English, Japanese and Chinese; *What moves* lists it with the \
reasons. Write others into *move* and *still*, one name on each line; `left sleeve=cloth` also says of what it is made.

**Paint on a frame:** *Frame as Layers* and *Save Layers* write any frame as a PSD file.
"""

_SEE_THROUGH_NOTE = """\
## One flat picture, cut into layers by See-through

See-through (SIGGRAPH 2026) cuts an anime character into up to 24 layers and paints what is hidden. *See-through Parts \
to Layers* takes them over, and the rest is as in the workflow *layers*.

**Needs the node pack ComfyUI-See-through** (MIT licence; its nodes are red until it is installed): \
https://github.com/jtydhr88/ComfyUI-See-through

**Models** come by themselves at the first run, or belong into `models/SeeThrough`; for their licences see their pages:

- https://huggingface.co/layerdifforg/seethroughv0.0.2_layerdiff3d
- https://huggingface.co/layerdifforg/seethroughv0.0.1_marigold

**Memory of the GPU:** 12 to 16 GB at a resolution of 1280. With less: *group_offload*, *quant_mode* nf4, or a lower \
*resolution*, but no lower than 768.

**Your own picture:** replace *Example Illustration* by *Load Image*. The layers are square: the picture is padded. \
They have no background; choose one in *Render*.
"""


def layers() -> tuple[Group, ...]:
    """The bundled example in layers, from its file to a video."""
    note = core("note", "MarkdownNote", 470, "Layers", {"": _LAYERS_NOTE})
    return (
        Group("1 · Illustration in layers", BLUE, (Column(400, (note, ours("load", "LoadLayers", 390))),)),
        *_moved("layers", "load.layers", 2),
    )


def see_through() -> tuple[Group, ...]:
    """A flat picture, cut by the See-through nodes."""
    note = core("note", "MarkdownNote", 560, "See-through", {"": _SEE_THROUGH_NOTE})
    cut = (
        core("model", "SeeThrough_LoadLayerDiffModel"),
        core("cut", "SeeThrough_GenerateLayers", image="example.image", layerdiff_model="model.layerdiff_model"),
        core("depth_model", "SeeThrough_LoadDepthModel"),
        core("depth", "SeeThrough_GenerateDepth", layers="cut.layers", depth_model="depth_model.depth_model"),
        core("parts", "SeeThrough_PostProcess", layers_depth="depth.layers_depth"),
        ours("layers", "SeeThroughLayers", 330, parts="parts.parts"),
    )
    return (
        Group("1 · Illustration", BLUE, (Column(400, (note, ours("example", "ExampleIllustration", 370))),)),
        Group("2 · Cut into layers", TEAL, (Column(360, cut),)),
        *_moved(SEE_THROUGH, "layers.layers", 3),
    )


def _moved(name: str, source: str, number: int) -> tuple[Group, ...]:
    """From layers to a saved video, with the automatic scene."""
    values: dict[str, Any] = {"filename_prefix": f"PhysAnimator/{name}"}
    shown = {"image": "bodies.image", "motion": "simulate.motion", "scene": "scene.scene"}
    bodies: tuple[Node, ...] = (
        ours("bodies", "ArtworkToBodies", 720, layers=source),
        core("report", "PreviewAny", 260, "What moves", {}, source="bodies.report"),
    )
    simulated = (
        ours("scene", "AutomaticScene", bodies="bodies.bodies"),
        ours("simulate", "Simulate", scene="scene.scene"),
        ours("preview", "PreviewMotion", 430, **shown),
    )
    video = (
        ours("render", "Render", image="bodies.image", motion="simulate.motion"),
        core("video", "CreateVideo", images="render.frames", fps="simulate.frame_rate"),
        core("save", "SaveVideo", 480, "", values, video="video.VIDEO"),
    )
    return (
        Group(f"{number} · What moves", GREEN, (Column(360, bodies),)),
        Group(f"{number + 1} · Physics simulation", ORANGE, (Column(420, simulated),)),
        Group(f"{number + 2} · Frames and video", PURPLE, (Column(520, video),)),
    )


LAYER_WORKFLOWS = {"layers": layers, SEE_THROUGH: see_through}
