"""What the host's video models take: warped frames with holes, moving lines, first and last frames."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comfy_api.latest import io

from ..rendering.control import ModelFormat
from .drawing import drawing_inputs, drawing_of, in_front_input, told_of_another_picture
from .host import (
    all_told,
    announce_batch,
    batch_of_pictures,
    drawn_lines,
    host_progress,
    mask_batch,
    picture_batch,
    picture_of,
    sketch_lines_input,
    told_of_light_lines,
)
from .host.wires import MaskedMotion, MotionWire
from .video_format_inputs import (
    form_outputs,
    form_values,
    given_plate,
    length_input,
    plate_input,
    refused_form,
    size_inputs,
)

if TYPE_CHECKING:
    import torch

    from ..physics.motion import Fit
    from ..rendering.sketch import LineTones

__all__ = ["FirstAndLastFrame", "LineControlVideo", "WarpedVideo"]

_LINES = ("white on black", "black on white")


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
                *drawing_inputs(),
                length_input(),
                *size_inputs(),
                io.Int.Input(
                    "grow",
                    default=4,
                    min=0,
                    max=64,
                    tooltip="How far holes reach beyond what was uncovered [px of the illustration].",
                ),
                plate_input(),
                in_front_input(),
            ],
            outputs=[
                io.Image.Output(display_name="control_video", tooltip="For WanVaceToVideo's control_video."),
                io.Mask.Output(display_name="control_masks", tooltip="White where the model shall paint."),
                *form_outputs(),
            ],
        )

    @classmethod
    def validate_inputs(
        cls, frames: int | None = None, width: int | None = None, height: int | None = None
    ) -> bool | str:
        return refused_form(frames=frames, width=width, height=height)

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
        plate = given_plate(clean_plate)
        drawing = drawing_of(motion, picture, plate=plate, in_front=in_front)
        told = announce_batch(cls, frames, width, height, channels=4)
        told = all_told(told, told_of_another_picture(cls, motion, picture, plate))
        pictures, holes = picture_batch(frames), mask_batch(frames)
        drawn = warped_frames(picture, motion.masks, motion.motion, form, grow=grow, renderer=drawing)
        for number, (picture, hole) in enumerate(drawn, start=1):
            pictures.put(picture)
            holes.put(hole)
            report(number, frames)
        return io.NodeOutput(pictures.tensor, holes.tensor, *form_values(form, motion), ui=told or None)


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
                io.Image.Input("sketch", tooltip="A line drawing of the illustration, one picture: see sketch_lines."),
                MotionWire.Input("motion", tooltip="From Simulate."),
                length_input(),
                *size_inputs(),
                io.Combo.Input(
                    "lines",
                    options=list(_LINES),
                    default=_LINES[0],
                    tooltip="white on black: as edge detectors draw, for control models. black on white: as drawn.",
                ),
                sketch_lines_input(),
            ],
            outputs=[
                io.Image.Output(display_name="control_video", tooltip="One line drawing a frame."),
                *form_outputs(),
            ],
        )

    @classmethod
    def validate_inputs(
        cls, frames: int | None = None, width: int | None = None, height: int | None = None
    ) -> bool | str:
        return refused_form(frames=frames, width=width, height=height)

    @classmethod
    def execute(
        cls,
        sketch: torch.Tensor,
        motion: MaskedMotion,
        frames: int,
        width: int,
        height: int,
        fit: Fit,
        lines: str,
        sketch_lines: LineTones = "automatic",
    ) -> io.NodeOutput:
        from ..rendering.control import line_frames

        form, report = ModelFormat(frames, width, height, fit), host_progress()
        moved = motion.motion
        drawing = drawn_lines(sketch, moved.width, moved.height, sketch_lines)
        told, batch = announce_batch(cls, frames, width, height), picture_batch(frames)
        told = all_told(told, told_of_light_lines(cls, sketch, sketch_lines))
        own = behind = None
        if motion.layers is not None:
            own, behind = motion.layers.own_sketches(), motion.layers.sketch_behind(moved)
        drawn = line_frames(drawing, moved, form, bright_lines=lines == _LINES[0], behind=behind, own=own)
        for number, picture in enumerate(drawn, start=1):
            batch.put(picture)
            report(number, frames)
        return io.NodeOutput(batch.tensor, *form_values(form, motion), ui=told or None)


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
                *drawing_inputs(),
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
                *size_inputs(),
                plate_input(),
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
    def validate_inputs(cls, width: int | None = None, height: int | None = None) -> bool | str:
        return refused_form(width=width, height=height)

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
        plate = given_plate(clean_plate)
        drawing = drawing_of(motion, picture, plate=plate, in_front=in_front)
        told = told_of_another_picture(cls, motion, picture, plate)
        chosen = {"first": first_frame, "last": last_frame, "renderer": drawing}
        both = first_and_last(picture, motion.masks, motion.motion, form, **chosen)
        start, end = (batch_of_pictures([each], 1) for each in both)
        return io.NodeOutput(start, end, width, height, ui=told or None)
