"""What Time-to-Move takes: a crude animation, where it moves, and its first frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..physics.motion import FITS, Fit
from ..rendering.control import AREAS, FRAME_STEP, SIZE_STEP, TIMINGS, ModelFormat, Timing
from .drawing import clean_plate_input, drawing_inputs, drawing_of, in_front_input, told_of_another_picture
from .host import (
    all_told,
    announce_batch,
    batch_of_pictures,
    host_progress,
    mask_batch,
    picture_batch,
    picture_of,
    tell_user,
)
from .host.wires import MaskedMotion
from .video_format_inputs import form_outputs, given_plate, refused_form

if TYPE_CHECKING:
    import torch

__all__ = ["TimeToMove"]

_USUAL = ModelFormat()
_OWN_SIZE = "width and height"


class TimeToMove(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_TimeToMove",
            display_name="Time-to-Move Inputs",
            category="PhysAnimator/video models",
            description="The animation of the physics as a crude one that a video model repaints, the mask of its"
            " moving parts and its first frame, in one size and length: for WanVideoAddTTMLatents, or the host's own"
            " samplers.",
            inputs=[
                *drawing_inputs(),
                io.Int.Input(
                    "frames",
                    default=_USUAL.frames,
                    min=1,
                    max=10_001,
                    step=FRAME_STEP,
                    tooltip="Length of the clip; 4 k + 1 [frames]. Wan knows 81 best, which are 5 s at 16 a second.",
                ),
                io.Combo.Input(
                    "timing",
                    options=list(TIMINGS),
                    default=TIMINGS[0],
                    tooltip="whole motion: from its first frame to its last in so many frames, drawn anew between them."
                    " frame by frame: its own frames, the rest left out, or the last one held. own length: its own"
                    " frames, the last one held until the length is 4 k + 1; frames does not count then.",
                ),
                io.Combo.Input(
                    "size",
                    options=[*AREAS, _OWN_SIZE],
                    default="480p",
                    tooltip="480p, 720p: as large as 832 x 480 or 1280 x 720 px in the illustration's own proportions,"
                    f" sides multiples of 16. {_OWN_SIZE}: as said below.",
                ),
                *(
                    io.Int.Input(
                        side,
                        default=getattr(_USUAL, side),
                        min=SIZE_STEP,
                        max=8192,
                        step=SIZE_STEP,
                        tooltip=f"{side.capitalize()} of the video where size is {_OWN_SIZE}; a multiple of 16 [px].",
                    )
                    for side in ("width", "height")
                ),
                io.Combo.Input(
                    "fit",
                    options=list(FITS),
                    default=_USUAL.fit,
                    tooltip="How the illustration comes to that size: cut to its middle, or stretched. Animation, mask"
                    " and first frame alike.",
                ),
                io.Int.Input(
                    "grow",
                    default=0,
                    min=0,
                    max=64,
                    tooltip="How far the mask reaches beyond the moving parts [px of the illustration]. It covers whole"
                    " cells of 8 x 8 px in any case.",
                ),
                clean_plate_input(),
                in_front_input(),
            ],
            outputs=[
                io.Image.Output(
                    display_name="crude_animation", tooltip="Encode it: for WanVideoAddTTMLatents' reference_latents."
                ),
                io.Mask.Output(
                    display_name="mask", tooltip="White where moving parts are: for WanVideoAddTTMLatents' mask."
                ),
                io.Image.Output(display_name="first_frame", tooltip="For the model's start_image."),
                *form_outputs(),
                io.Mask.Output(
                    display_name="free_latents",
                    tooltip="White where the model is free, one pixel for each latent of Wan's: for Set Latent Noise"
                    " Mask, where the host's own samplers do Time-to-Move.",
                ),
                io.String.Output(display_name="rules", tooltip="What became of length and size, in words."),
            ],
        )

    @classmethod
    def validate_inputs(
        cls,
        frames: int | None = None,
        timing: str | None = None,
        size: str | None = None,
        width: int | None = None,
        height: int | None = None,
    ) -> bool | str:
        used = {"frames": frames} if timing in TIMINGS[:2] else {}
        return refused_form(**used | ({"width": width, "height": height} if size == _OWN_SIZE else {}))

    @classmethod
    def execute(
        cls,
        image: torch.Tensor,
        motion: MaskedMotion,
        frames: int,
        timing: Timing,
        size: str,
        width: int,
        height: int,
        fit: Fit,
        grow: int,
        clean_plate: torch.Tensor | None = None,
        in_front: torch.Tensor | None = None,
    ) -> io.NodeOutput:
        from ..rendering.control import time_to_move, timed, told_rules

        moved, picture, report = motion.motion, picture_of(image), host_progress()
        form = _form(moved, frames, timing, size, (width, height), fit)
        plate = given_plate(clean_plate)
        drawing = drawing_of(motion, picture, plate=plate, in_front=in_front)
        rules = told_rules(moved, form, timing)
        left_out = rules[:1] if timing == "frame by frame" and len(moved) > form.frames else []
        told = announce_batch(cls, form.frames, form.width, form.height, channels=4)
        told = all_told(told, tell_user(cls, left_out), told_of_another_picture(cls, motion, picture, plate))
        pictures, masks = picture_batch(form.frames), mask_batch(form.frames)
        free = mask_batch((form.frames - 1) // FRAME_STEP + 1)
        done = 0
        for step in time_to_move(picture, motion.masks, moved, form, timing=timing, grow=grow, renderer=drawing):
            free.put(1.0 - step.cells)
            for frame in step.frames:
                pictures.put(frame)
                masks.put(step.mask)
                done += 1
                report(done, form.frames)
        first = batch_of_pictures([pictures.tensor[0].numpy()], 1)
        rate = timed(moved, form, timing).frame_rate
        sizes = (form.width, form.height, form.frames, rate)
        outputs = (pictures.tensor, masks.tensor, first, *sizes, free.tensor, " ".join(rules))
        return io.NodeOutput(*outputs, ui=told or None)


def _form(motion: Any, frames: int, timing: Timing, size: str, sides: tuple[int, int], fit: Fit) -> ModelFormat:
    """Length and size of the clip, by the node's inputs."""
    from ..rendering.control import suitable_length, suitable_size

    if size in AREAS:
        sides = suitable_size(motion.width, motion.height, AREAS[size])
    return ModelFormat(suitable_length(len(motion)) if timing == "own length" else frames, *sides, fit)
