"""Line drawings: from the illustration, and bent along with the motion (paper, Method, "Sketch Warping")."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from .host import (
    all_told,
    announce_batch,
    batch_of_pictures,
    default_of,
    drawn_lines,
    host_progress,
    is_wanted,
    mask_batch,
    not_made,
    picture_batch,
    picture_of,
    sketch_lines_input,
    told_of_light_lines,
)
from .host.wires import FlowOfMotion, FlowWire
from .models.drawing_network import drawing_network_inputs, missing_drawing_file, network_sketch

if TYPE_CHECKING:
    import torch

    from ..rendering.sketch import LineTones, WarpMode

__all__ = ["ExtractSketch", "WarpSketch"]

_HOLES = 1  # number of the output
_GAUSSIANS, _NETWORK = "difference of Gaussians", "drawing network"


class ExtractSketch(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        from ..rendering.sketch import extract_sketch

        return io.Schema(
            node_id="PhysAnimator_ExtractSketch",
            display_name="Extract Sketch",
            category="PhysAnimator/sketch",
            description="Draws the illustration's lines on white paper: without any model file, or by a network.",
            inputs=[
                io.Image.Input("image", tooltip="The illustration (one picture)."),
                io.Float.Input(
                    "line_width",
                    default=default_of(extract_sketch, "line_width"),
                    min=0.5,
                    max=50.0,
                    step=0.1,
                    tooltip="Width of the lines to look for [px]; not for a network.",
                ),
                io.Float.Input(
                    "threshold",
                    default=default_of(extract_sketch, "threshold"),
                    min=0.001,
                    max=0.9,
                    step=0.001,
                    round=0.001,
                    tooltip="How much darker than its surroundings a line must be [0 to 1]; higher drops faint lines.",
                ),
                io.Float.Input(
                    "coherence",
                    default=default_of(extract_sketch, "coherence"),
                    min=0.0,
                    max=20.0,
                    step=0.5,
                    tooltip="Length over which lines are smoothed along their own direction [px]; not for a network.",
                ),
                io.Int.Input(
                    "smallest_speck",
                    default=default_of(extract_sketch, "smallest_speck"),
                    min=0,
                    max=100_000,
                    tooltip="Connected lines with less area than this are left out [px^2].",
                ),
                io.DynamicCombo.Input(
                    "extractor",
                    options=[
                        io.DynamicCombo.Option(_GAUSSIANS, []),
                        io.DynamicCombo.Option(_NETWORK, drawing_network_inputs()),
                    ],
                    optional=True,
                    tooltip=f"{_GAUSSIANS}: needs no model. {_NETWORK}: informative drawings or Anime2Sketch, for which"
                    " a model file is needed.",
                ),
            ],
            outputs=[io.Image.Output(display_name="sketch", tooltip="Dark lines on white paper.")],
        )

    @classmethod
    def validate_inputs(cls, extractor: dict[str, Any] | None = None, **others: Any) -> bool | str:
        # The host hands over what a choice brings only to a function that takes every input.
        return missing_drawing_file(extractor or {}) or True

    @classmethod
    def execute(
        cls,
        image: torch.Tensor,
        line_width: float,
        threshold: float,
        coherence: float,
        smallest_speck: int,
        extractor: dict[str, Any] | None = None,
    ) -> io.NodeOutput:
        from ..rendering.sketch import extract_sketch

        picture, kept = picture_of(image), {"threshold": threshold, "smallest_speck": smallest_speck}
        if extractor is not None and extractor["extractor"] == _NETWORK:
            sketch = network_sketch(picture, extractor, **kept)
        else:
            sketch = extract_sketch(picture, line_width=line_width, coherence=coherence, **kept)
        return io.NodeOutput(batch_of_pictures([sketch], 1))


class WarpSketch(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        from ..rendering.sketch import WARP_MODES, warped_sketches

        return io.Schema(
            node_id="PhysAnimator_WarpSketch",
            display_name="Warp Sketch",
            category="PhysAnimator/sketch",
            description="Bends a sketch of the illustration along with the motion: one sketch for each frame.",
            inputs=[
                io.Image.Input("sketch", tooltip="A line drawing of the illustration, one picture: see sketch_lines."),
                FlowWire.Input("flow", tooltip="How far each pixel has moved, from Optical Flow."),
                io.Combo.Input(
                    "mode",
                    options=list(WARP_MODES),
                    default=default_of(warped_sketches, "mode"),
                    tooltip="layered: each body's lines move with its mesh and lie over the still ones in depth order."
                    " paper, softmax: single pixels move, and where several meet the one that moved further shows, in"
                    " proportion to how far or far more decidedly.",
                ),
                io.Float.Input(
                    "blur_sigma",
                    default=default_of(warped_sketches, "blur_sigma"),
                    min=0.0,
                    max=100.0,
                    step=0.1,
                    tooltip="Width of the Gaussian blur that hides broken contours [px]; 0 for none.",
                ),
                io.Image.Input(
                    "lines_behind",
                    optional=True,
                    tooltip="Sketch of the clean plate: lines that show where a body leaves. Only layered takes it;"
                    " without it paper is there, and of layers what is drawn there.",
                ),
                sketch_lines_input(),
            ],
            outputs=[
                io.Image.Output(display_name="sketches", tooltip="One sketch a frame."),
                io.Mask.Output(
                    display_name="holes",
                    tooltip="White where nothing came to lie: what is behind a body shows there. Made only where it is"
                    " connected.",
                ),
            ],
        )

    @classmethod
    def fingerprint_inputs(cls, **inputs: Any) -> bool:
        return is_wanted(_HOLES)

    @classmethod
    def execute(
        cls,
        sketch: torch.Tensor,
        flow: FlowOfMotion,
        mode: WarpMode,
        blur_sigma: float,
        lines_behind: torch.Tensor | None = None,
        sketch_lines: LineTones = "automatic",
    ) -> io.NodeOutput:
        from ..rendering.sketch import warped_sketches

        count, width, height, report = len(flow), flow.motion.width, flow.motion.height, host_progress()
        drawing, behind = (
            None if each is None else drawn_lines(each, width, height, sketch_lines, name=name)
            for name, each in (("sketch", sketch), ("lines_behind", lines_behind))
        )
        sketches, holes = picture_batch(count), mask_batch(count) if is_wanted(_HOLES) else None
        told = announce_batch(cls, count, width, height, channels=3 + (holes is not None))
        told = all_told(told, told_of_light_lines(cls, sketch, sketch_lines))
        own = None
        if flow.layers is not None and mode == "layered":
            own = flow.layers.own_sketches()
            behind = flow.layers.sketch_behind(flow.motion) if behind is None else behind
        warped = warped_sketches(drawing, flow, mode=mode, behind=behind, own=own, blur_sigma=blur_sigma)
        for number, each in enumerate(warped, start=1):
            sketches.put(each.sketch)
            if holes is not None:
                holes.put(each.holes)
            report(number, count)
        uncovered = not_made("holes") if holes is None else holes.tensor
        return io.NodeOutput(sketches.tensor, uncovered, ui=told or None)
