"""Optical flow of a motion, a look at it, and motion vectors for compositing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from comfy_api.latest import io

from ..rendering.export import VECTOR_CHANNELS, VectorChannels, check_openexr
from .host import (
    EXR,
    announce_batch,
    check_prefix,
    free_place,
    host_progress,
    picture_batch,
    refusal,
    shown_with,
)
from .host.previews import animated
from .host.wires import FlowOfMotion, FlowWire, MaskedMotion, MotionWire

if TYPE_CHECKING:
    from ..physics.motion import FlowSequence

__all__ = ["OpticalFlow", "PreviewFlow", "SaveMotionVectors"]


class OpticalFlow(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_OpticalFlow",
            display_name="Optical Flow (PhysAnimator)",
            category="PhysAnimator/motion",
            description="How far each pixel of the drawing has moved, frame by frame; computed when needed.",
            inputs=[MotionWire.Input("motion", tooltip="From Simulate.")],
            outputs=[FlowWire.Output(display_name="flow", tooltip="Displacement of each pixel from the drawing [px].")],
        )

    @classmethod
    def execute(cls, motion: MaskedMotion) -> io.NodeOutput:
        return io.NodeOutput(FlowOfMotion(motion))


class PreviewFlow(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_PreviewFlow",
            display_name="Preview Flow (PhysAnimator)",
            category="PhysAnimator/motion",
            description="Shows optical flow as colours: the hue is the direction, the strength how far a pixel moved.",
            is_output_node=True,
            inputs=[
                FlowWire.Input("flow", tooltip="From Optical Flow."),
                io.Int.Input("every", default=4, min=1, max=1000, tooltip="Shows only every n-th frame [frames]."),
                io.Float.Input(
                    "largest",
                    default=0.0,
                    min=0.0,
                    max=100_000.0,
                    step=1.0,
                    tooltip="Movement with the fullest colour [px]; 0 takes the largest of the clip.",
                ),
            ],
            outputs=[io.Image.Output(display_name="preview", tooltip="One picture for each frame shown.")],
        )

    @classmethod
    def execute(cls, flow: FlowOfMotion, every: int, largest: float) -> io.NodeOutput:
        from ..rendering.overlays import flow_to_color

        shown, report = range(0, len(flow), every), host_progress()
        instead = "raise every to show fewer frames"
        told = announce_batch(cls, len(shown), flow.motion.width, flow.motion.height, instead=instead)
        scale = largest or _largest(flow, shown)
        batch = picture_batch(len(shown))
        for number, frame in enumerate(shown, start=1):
            field = flow.flow(frame)
            batch.put(flow_to_color(field.displacement, field.inside, max_px=scale))
            report(number, len(shown))
        return io.NodeOutput(batch.tensor, ui=shown_with(animated(batch.tensor, flow.motion.frame_rate / every), told))


class SaveMotionVectors(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_SaveMotionVectors",
            display_name="Save Motion Vectors (EXR)",
            category="PhysAnimator/motion",
            description="Saves how each pixel goes on to the next frame and came from the one before, exactly: for"
            " motion blur, retiming and tracking in compositing programs. Needs the package OpenEXR.",
            is_output_node=True,
            inputs=[
                MotionWire.Input("motion", tooltip="From Simulate."),
                io.String.Input(
                    "filename_prefix",
                    default="vectors/PhysAnimator",
                    tooltip="Name of the folder in the output folder, with folders if you like; a number is added,"
                    " nothing is overwritten.",
                ),
                io.Combo.Input(
                    "channels",
                    options=list(VECTOR_CHANNELS),
                    default=VECTOR_CHANNELS[0],
                    tooltip="nuke: forward.u, forward.v, backward.u, backward.v. blender: the pass Vector as Cycles"
                    " writes it. Both in pixels a frame, x right and y up, 32 bits.",
                ),
            ],
            outputs=[io.String.Output(display_name="path", tooltip="The folder of files, one for each frame.")],
        )

    @classmethod
    def validate_inputs(cls, filename_prefix: str | None = None) -> bool | str:
        # Before the simulation, not after it.
        return refusal(check_openexr, *([] if filename_prefix is None else [lambda: check_prefix(filename_prefix)]))

    @classmethod
    def execute(cls, motion: MaskedMotion, filename_prefix: str, channels: VectorChannels) -> io.NodeOutput:
        from ..rendering.export import save_motion_vectors

        moved = motion.motion
        place = free_place(filename_prefix, EXR, moved.width, moved.height)
        save_motion_vectors(moved, place.path, channels=channels, progress=host_progress())
        return io.NodeOutput(place.path, ui={"text": [f"{place.name}: {len(moved)} files"]})


def _largest(flow: FlowSequence, shown: range) -> float:
    """Largest movement of a vertex in the frames shown [px]; at least 1, so that stillness is not magnified."""
    moved = flow.motion.positions[shown] - flow.motion.positions[:1]
    return max(1.0, float(np.hypot(moved[..., 0], moved[..., 1]).max()))
