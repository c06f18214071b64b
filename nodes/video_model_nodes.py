"""What the host's video models take: warped frames with holes, moving lines, first and last frames."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..physics.motion import FITS, Fit
from ..rendering.control import FRAME_STEP, SIZE_STEP, ModelFormat
from .drawing import drawing_of, in_front_input, told_of_another_picture
from .host import all_told, announce_batch, batch_of_pictures, host_progress, mask_batch, picture_batch, picture_of
from .host.wires import MaskedMotion, MotionWire

if TYPE_CHECKING:
    import torch

__all__ = ["FirstAndLastFrame", "LineControlVideo", "WarpedVideo"]

_USUAL = ModelFormat()
_LINES = ("white on black", "black on white")


def _length() -> Any:
    return io.Int.Input(
        "frames",
        default=_USUAL.frames,
        min=1,
        max=10_001,
        step=FRAME_STEP,
        tooltip="Over the whole motion, from its first frame to its last; 4 k + 1 [frames], as in the model's node.",
    )


def _size() -> list[Any]:
    sides = [
        io.Int.Input(
            side,
            default=getattr(_USUAL, side),
            min=SIZE_STEP,
            max=8192,
            step=SIZE_STEP,
            tooltip=f"{side.capitalize()} of the video, as in the model's node; a multiple of 16 [px].",
        )
        for side in ("width", "height")
    ]
    fit = io.Combo.Input(
        "fit",
        options=list(FITS),
        default=_USUAL.fit,
        tooltip="How the illustration comes to that size: cut to its middle, as the model's node does with pictures, or"
        " stretched.",
    )
    return [*sides, fit]


def _plate() -> Any:
    return io.Image.Input(
        "clean_plate",
        optional=True,
        tooltip="The picture without the moving parts, if you have it. Painted automatically when left out.",
    )


def _form_outputs() -> list[Any]:
    return [
        io.Int.Output("out_width", display_name="width", tooltip="For the model's node [px]."),
        io.Int.Output("out_height", display_name="height", tooltip="For the model's node [px]."),
        io.Int.Output("out_length", display_name="length", tooltip="For the model's node [frames]."),
        io.Float.Output("frame_rate", display_name="frame_rate", tooltip="For Create Video [frames/s]."),
    ]


def _given(plate: torch.Tensor | None) -> Any:
    return None if plate is None else picture_of(plate, name="clean_plate")


def _form_values(form: ModelFormat, motion: MaskedMotion) -> tuple[int, int, int, float]:
    rate = motion.motion.frame_rate * (form.frames - 1) / max(1, len(motion.motion) - 1)
    return form.width, form.height, form.frames, rate


class WarpedVideo(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_WarpedVideo",
            display_name="Warped Video (for VACE)",
            category="PhysAnimator/video models",
            description="The illustration with its parts moved, grey where they have uncovered something, and masks of"
            " these holes: the control video and control masks of WanVaceToVideo.",
            inputs=[
                io.Image.Input("image", tooltip="The illustration (one picture)."),
                MotionWire.Input("motion", tooltip="From Simulate; it carries the masks along."),
                _length(),
                *_size(),
                io.Int.Input(
                    "grow",
                    default=4,
                    min=0,
                    max=64,
                    tooltip="How far holes reach beyond what was uncovered [px of the illustration].",
                ),
                _plate(),
                in_front_input(),
            ],
            outputs=[
                io.Image.Output(display_name="control_video", tooltip="For WanVaceToVideo's control_video."),
                io.Mask.Output(display_name="control_masks", tooltip="White where the model shall paint."),
                *_form_outputs(),
            ],
        )

    @classmethod
    def execute(
        cls,
        image: torch.Tensor,
        motion: MaskedMotion,
        frames: int,
        width: int,
        height: int,
        fit: Fit,
        grow: int,
        clean_plate: torch.Tensor | None = None,
        in_front: torch.Tensor | None = None,
    ) -> io.NodeOutput:
        from ..rendering.control import warped_frames

        form, picture, report = ModelFormat(frames, width, height, fit), picture_of(image), host_progress()
        drawing = drawing_of(motion, picture, plate=_given(clean_plate), in_front=in_front)
        told = announce_batch(cls, frames, width, height, channels=4)
        told = all_told(told, told_of_another_picture(cls, motion, picture))
        pictures, holes = picture_batch(frames), mask_batch(frames)
        drawn = warped_frames(picture, motion.masks, motion.motion, form, grow=grow, renderer=drawing)
        for number, (picture, hole) in enumerate(drawn, start=1):
            pictures.put(picture)
            holes.put(hole)
            report(number, frames)
        return io.NodeOutput(pictures.tensor, holes.tensor, *_form_values(form, motion), ui=told or None)


class LineControlVideo(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_LineControlVideo",
            display_name="Line Control Video",
            category="PhysAnimator/video models",
            description="A line drawing that moves along: the control video of Wan22FunControlToVideo, or of"
            " WanVaceToVideo.",
            inputs=[
                io.Image.Input("sketch", tooltip="Dark lines on white, one picture of the illustration's size."),
                MotionWire.Input("motion", tooltip="From Simulate."),
                _length(),
                *_size(),
                io.Combo.Input(
                    "lines",
                    options=list(_LINES),
                    default=_LINES[0],
                    tooltip="white on black: as edge detectors draw, for control models. black on white: as drawn.",
                ),
            ],
            outputs=[
                io.Image.Output(display_name="control_video", tooltip="One line drawing a frame."),
                *_form_outputs(),
            ],
        )

    @classmethod
    def execute(
        cls, sketch: torch.Tensor, motion: MaskedMotion, frames: int, width: int, height: int, fit: Fit, lines: str
    ) -> io.NodeOutput:
        from ..rendering.control import line_frames

        form, report = ModelFormat(frames, width, height, fit), host_progress()
        told, batch = announce_batch(cls, frames, width, height), picture_batch(frames)
        drawing = picture_of(sketch, name="sketch").mean(axis=2)
        own = behind = None
        if motion.layers is not None:
            own, behind = motion.layers.own_sketches(), motion.layers.sketch_behind(motion.motion)
        drawn = line_frames(drawing, motion.motion, form, bright_lines=lines == _LINES[0], behind=behind, own=own)
        for number, picture in enumerate(drawn, start=1):
            batch.put(picture)
            report(number, frames)
        return io.NodeOutput(batch.tensor, *_form_values(form, motion), ui=told or None)


class FirstAndLastFrame(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_FirstAndLastFrame",
            display_name="First And Last Frame",
            category="PhysAnimator/video models",
            description="Two frames of the motion: start and end image of WanFirstLastFrameToVideo, which draws what is"
            " between.",
            inputs=[
                io.Image.Input("image", tooltip="The illustration (one picture)."),
                MotionWire.Input("motion", tooltip="From Simulate; it carries the masks along."),
                io.Int.Input(
                    "first_frame",
                    default=0,
                    min=-10_000,
                    max=10_000,
                    tooltip="Number of the first frame of the motion; negative ones count from its end.",
                ),
                io.Int.Input(
                    "last_frame",
                    default=-1,
                    min=-10_000,
                    max=10_000,
                    tooltip="Number of the last frame of the motion; -1 is its very last.",
                ),
                *_size(),
                _plate(),
                in_front_input(),
            ],
            outputs=[
                io.Image.Output(display_name="start_image", tooltip="For WanFirstLastFrameToVideo."),
                io.Image.Output(display_name="end_image", tooltip="For WanFirstLastFrameToVideo."),
                io.Int.Output("out_width", display_name="width", tooltip="For the model's node [px]."),
                io.Int.Output("out_height", display_name="height", tooltip="For the model's node [px]."),
            ],
        )

    @classmethod
    def execute(
        cls,
        image: torch.Tensor,
        motion: MaskedMotion,
        first_frame: int,
        last_frame: int,
        width: int,
        height: int,
        fit: Fit,
        clean_plate: torch.Tensor | None = None,
        in_front: torch.Tensor | None = None,
    ) -> io.NodeOutput:
        from ..rendering.control import first_and_last

        form, picture = ModelFormat(width=width, height=height, fit=fit), picture_of(image)
        drawing = drawing_of(motion, picture, plate=_given(clean_plate), in_front=in_front)
        told = told_of_another_picture(cls, motion, picture)
        chosen = {"first": first_frame, "last": last_frame, "renderer": drawing}
        both = first_and_last(picture, motion.masks, motion.motion, form, **chosen)
        start, end = (batch_of_pictures([each], 1) for each in both)
        return io.NodeOutput(start, end, width, height, ui=told or None)
