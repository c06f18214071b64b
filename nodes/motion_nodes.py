"""The simulation, and a look at what it did."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
from comfy_api.latest import io
from numpy.typing import NDArray

from ..physics.fields import described_fields
from ..physics.interruption import interruptible
from ..physics.limits import DEFAULT_MINUTES, MAX_LOOP, MOST_MINUTES, TICK
from ..physics.scene import Scene, StrokesAs
from .host import (
    all_told,
    announce_batch,
    host_check,
    host_progress,
    picture_batch,
    pictures_for,
    server,
    shown_with,
    tell_user,
)
from .host.field_inputs import ADVANCED
from .host.previews import animated
from .host.wires import MaskedMotion, MaskedScene, MotionWire, SceneWire

if TYPE_CHECKING:
    import torch

__all__ = ["PreviewMotion", "Simulate"]

_AS_THE_SCENE = "as the scene says"


class Simulate(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_Simulate",
            display_name="Simulate (PhysAnimator)",
            category="PhysAnimator/motion",
            description="Computes by physics how the bodies of a scene move: hair sways, cloth flutters, jelly"
            " wobbles.",
            inputs=[
                SceneWire.Input("scene", tooltip="What moves, and what acts on it."),
                io.Int.Input(
                    "frames",
                    default=73,
                    min=1,
                    max=100_000,
                    tooltip="Number of frames; the first is the drawing. 73 frames at 24 a second last 3 s. With a"
                    " loop, its own length in frames is used instead.",
                ),
                io.Float.Input(
                    "loop",
                    default=0.0,
                    min=0.0,
                    max=MAX_LOOP,
                    step=0.5,
                    optional=True,
                    tooltip="Length of a seamless loop [s]: the last frame leads back to the first, which is not the"
                    " drawing then. All that acts is fitted to it. 0 is off, unless the scene has a loop;"
                    " the shortest has 2 frames.",
                ),
                io.Float.Input(
                    "max_minutes",
                    default=DEFAULT_MINUTES,
                    min=0.1,
                    max=MOST_MINUTES,
                    step=0.5,
                    optional=True,
                    tooltip="Computing time that is allowed [min], by the estimate for one core of an ordinary machine:"
                    " what would take longer is refused before it begins, with the estimate. Raise it to wait for"
                    " long clips, fine meshes and stiff materials.",
                ),
                io.Float.Input(
                    "time_step",
                    default=0.0,
                    min=0.0,
                    max=TICK,
                    step=0.0001,
                    round=0.000001,
                    optional=True,
                    tooltip="Step of plain semi-implicit Euler [s], all forces evaluated in each: 0.001 is the paper's."
                    " Where it would be unstable it is refused, with the longest that is not. 0: steps follow from the"
                    " mesh, unless the scene has a time step.",
                    **ADVANCED,
                ),
                io.Combo.Input(
                    "strokes_as",
                    options=[_AS_THE_SCENE, *get_args(StrokesAs)],
                    default=_AS_THE_SCENE,
                    optional=True,
                    tooltip=f"{described_fields(Scene)['strokes_as'].input.tooltip} '{_AS_THE_SCENE}': as its document"
                    " says, which is an acceleration where it says nothing.",
                    **ADVANCED,
                ),
                io.Boolean.Input(
                    "sag",
                    default=False,
                    optional=True,
                    tooltip="Bodies are drawn without their weight: gravity makes them sag from the first frame on, as"
                    " in the paper. Off: what is held hangs as it is drawn, unless the scene sags.",
                    **ADVANCED,
                ),
            ],
            outputs=[
                MotionWire.Output(display_name="motion", tooltip="Where every part of every body is in each frame."),
                io.Float.Output(
                    display_name="frame_rate", tooltip="The scene's frames a second: for Create Video [1/s]."
                ),
            ],
        )

    @classmethod
    def execute(
        cls,
        scene: MaskedScene,
        frames: int,
        loop: float = 0.0,
        max_minutes: float = DEFAULT_MINUTES,
        time_step: float = 0.0,
        strokes_as: str = _AS_THE_SCENE,
        sag: bool = False,
    ) -> io.NodeOutput:
        from ..physics.motion import stillness
        from ..physics.scene import advice
        from ..physics.simulation import compile_aside, simulate, simulated_aside

        loop = max(loop, 2 / scene.scene.frame_rate) if loop else 0.0  # a widget has no gap between 0 and the least
        said: dict[str, Any] = {"loop": loop, "time_step": time_step, "sag": sag}
        said["strokes_as"] = "" if strokes_as == _AS_THE_SCENE else strokes_as
        acting = replace(scene.scene, **{name: value for name, value in said.items() if value})
        told = tell_user(cls, advice(acting, masks=False))  # Mask to Mesh has spoken of those
        wanted = None if acting.loop else frames
        touches, serves = acting.contact is not None, server() is not None  # it has to answer meanwhile
        with interruptible(host_check()), simulated_aside(contact=touches and serves):
            if serves:
                compile_aside(contact=touches)
            motion = simulate(acting, frames=wanted, progress=host_progress(), max_minutes=max_minutes)
        told = all_told(told, tell_user(cls, stillness(motion)))
        moved = MaskedMotion(motion, scene.masks, scene.layers, scene.in_front)
        return io.NodeOutput(moved, motion.frame_rate, ui=told or None)


class PreviewMotion(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_PreviewMotion",
            display_name="Preview Motion (PhysAnimator)",
            category="PhysAnimator/motion",
            description="Shows the moving meshes on the picture, with strokes and rig points.",
            is_output_node=True,
            inputs=[
                io.Image.Input(
                    "image", tooltip="The illustration, or the rendered frames: one picture for each frame."
                ),
                MotionWire.Input("motion", tooltip="From Simulate."),
                io.Int.Input(
                    "longest_side",
                    default=640,
                    min=64,
                    max=16384,
                    step=16,
                    tooltip="Longest side of the preview [px]; never larger than the illustration.",
                ),
                io.Int.Input(
                    "every",
                    default=2,
                    min=1,
                    max=1000,
                    tooltip="Shows only every n-th frame, and as slowly as the motion is [frames].",
                ),
                SceneWire.Input("scene", optional=True, tooltip="Connect it to see strokes, particles and rig points."),
            ],
            outputs=[io.Image.Output(display_name="preview", tooltip="The frames of the preview.")],
        )

    @classmethod
    def execute(
        cls, image: torch.Tensor, motion: MaskedMotion, longest_side: int, every: int, scene: MaskedScene | None = None
    ) -> io.NodeOutput:
        from ..rendering.overlays import preview

        moved, acting = motion.motion, scene.scene if scene else None
        pictures = _shrunk(pictures_for(image, moved.width, moved.height, frames=len(moved)), longest_side)
        shown, report = range(0, len(moved), every), host_progress()
        small_height, small_width = pictures[0].shape[:2]
        instead = "raise every, or lower longest_side"
        told = announce_batch(cls, len(shown), small_width, small_height, instead=instead)
        batch = picture_batch(len(shown))
        for number, frame in enumerate(shown, start=1):
            batch.put(preview(pictures[frame % len(pictures)], moved, acting, frame))
            report(number, len(shown))
        return io.NodeOutput(batch.tensor, ui=shown_with(animated(batch.tensor, moved.frame_rate / every), told))


def _shrunk(pictures: NDArray[np.float32], longest_side: int) -> list[NDArray[np.uint8]]:
    """Pictures no larger than wanted, as bytes, which are quicker to draw on."""
    import cv2

    from ..rendering.pictures import as_uint8

    scale = min(1.0, longest_side / max(pictures.shape[1:3]))
    size = (max(1, round(pictures.shape[2] * scale)), max(1, round(pictures.shape[1] * scale)))
    small = (cv2.resize(picture, size, interpolation=cv2.INTER_AREA) for picture in pictures)
    return [as_uint8(picture) for picture in small]
