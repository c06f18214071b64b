"""Keyframes at chosen frames of a clip, and the conditioning of Wan's image-to-video models by them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..rendering.control import ModelFormat, check_length
from .drawing import drawing_inputs, drawing_of, in_front_input, told_of_another_picture
from .host import (
    all_told,
    announce_batch,
    batch_of_masks,
    batch_of_pictures,
    drawn_lines,
    host_check,
    not_made,
    picture_of,
    pictures_of,
    sketch_lines_input,
    told_of_light_lines,
    whole_numbers_of,
)
from .host.wires import MaskedMotion
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

__all__ = ["Keyframes", "WanKeyframes"]

_FIRST_MIDDLE_LAST = "0, 40, -1"
_USUAL = ModelFormat()


class Keyframes(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_Keyframes",
            display_name="Keyframes (for in-betweens)",
            category="PhysAnimator/video models",
            description="Frames of the motion at chosen places of a clip, between which a video model draws: for"
            " Keyframes to Wan Video, for WanVaceToVideo, or to be painted over by hand first.",
            inputs=[
                *drawing_inputs(),
                length_input(),
                *size_inputs(),
                io.String.Input(
                    "keyframes",
                    default=_FIRST_MIDDLE_LAST,
                    tooltip="Numbers of the keyframes in the clip, from 0; negative ones count from its end. AniSora"
                    " takes multiples of 8.",
                ),
                plate_input(),
                in_front_input(),
                io.Image.Input(
                    "sketch",
                    optional=True,
                    tooltip="A line drawing of the illustration, one picture: it gives sketches at the same frames.",
                ),
                sketch_lines_input(),
            ],
            outputs=[
                io.Image.Output("keyframes_out", display_name="keyframes", tooltip="One picture for each number."),
                io.String.Output(display_name="indices", tooltip="Their numbers in the clip, from 0: 0, 40, 80."),
                io.Image.Output(
                    display_name="control_video", tooltip="The clip: keyframes in their places, grey elsewhere."
                ),
                io.Mask.Output(display_name="control_masks", tooltip="White in the frames that are to be painted."),
                io.Image.Output(
                    display_name="sketches",
                    tooltip="The sketch at each keyframe, dark lines on white. Made only with a sketch.",
                ),
                *form_outputs(),
            ],
        )

    @classmethod
    def validate_inputs(
        cls,
        frames: int | None = None,
        width: int | None = None,
        height: int | None = None,
        keyframes: str | None = None,
    ) -> bool | str:
        known = keyframes is not None and frames is not None
        checks = [lambda: _numbers(keyframes or "", frames or 0)] if known else []
        return refused_form(*checks, frames=frames, width=width, height=height)

    @classmethod
    def execute(
        cls,
        image: torch.Tensor,
        motion: MaskedMotion,
        frames: int,
        width: int,
        height: int,
        fit: Fit,
        keyframes: str,
        clean_plate: torch.Tensor | None = None,
        in_front: torch.Tensor | None = None,
        sketch: torch.Tensor | None = None,
        sketch_lines: LineTones = "automatic",
    ) -> io.NodeOutput:
        from ..rendering.control import motion_keyframes, placed_keyframes

        form, picture = ModelFormat(frames, width, height, fit), picture_of(image)
        at = _numbers(keyframes, frames)
        plate = given_plate(clean_plate)
        drawing = drawing_of(motion, picture, plate=plate, in_front=in_front)
        told = announce_batch(cls, frames, width, height, channels=4)
        told = all_told(told, told_of_another_picture(cls, motion, picture, plate))
        told = all_told(told, told_of_light_lines(cls, sketch, sketch_lines))
        drawn = motion_keyframes(picture, motion.masks, motion.motion, form, at=at, renderer=drawing)
        host_check()
        clip, missing = placed_keyframes(drawn, at, frames)
        lines = not_made("sketches") if sketch is None else _sketches(sketch, motion, form, at, sketch_lines)
        pictures = (batch_of_pictures(each, len(each)) for each in (drawn, clip))
        first, video = pictures
        made = (first, ", ".join(map(str, at)), video, batch_of_masks(missing, frames), lines)
        return io.NodeOutput(*made, *form_values(form, motion), ui=told or None)


def _numbers(text: str, frames: int) -> tuple[int, ...]:
    from ..rendering.control import moments

    return moments(whole_numbers_of(text, name="keyframes"), frames)


def _sketches(
    sketch: torch.Tensor, motion: MaskedMotion, form: ModelFormat, at: tuple[int, ...], tones: LineTones
) -> torch.Tensor:
    """The sketch bent along, at these frames."""
    from ..rendering.control import line_frames

    moved, own, behind = motion.motion, None, None
    if motion.layers is not None:
        own, behind = motion.layers.own_sketches(), motion.layers.sketch_behind(moved)
    drawing = drawn_lines(sketch, moved.width, moved.height, tones)
    lines = line_frames(drawing, moved, form, bright_lines=False, behind=behind, own=own, at=at)
    return batch_of_pictures(lines, len(at))


class WanKeyframes(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_WanKeyframes",
            display_name="Keyframes to Wan Video (AniSora)",
            category="PhysAnimator/video models",
            description="Shows keyframes at any frames of the clip to Wan's image-to-video models: to AniSora, which"
            " was trained for it. As WanFirstLastFrameToVideo, which knows the first frame and the last only.",
            inputs=[
                io.Conditioning.Input("positive", tooltip="What is to be seen."),
                io.Conditioning.Input("negative", tooltip="What is not."),
                io.Vae.Input("vae", tooltip="Wan 2.1's VAE."),
                *size_inputs()[:2],
                io.Int.Input(
                    "length",
                    default=_USUAL.frames,
                    min=1,
                    max=10_001,
                    step=4,
                    tooltip="Of the clip; 4 k + 1 [frames].",
                ),
                io.Int.Input("batch_size", default=1, min=1, max=64, tooltip="Clips that are made at once."),
                io.Image.Input("keyframes", tooltip="From Keyframes, or painted by hand: one for each of indices."),
                io.String.Input(
                    "indices",
                    default=_FIRST_MIDDLE_LAST,
                    tooltip="The frame of each keyframe, in the same order, from 0; negative ones count from the end."
                    " AniSora takes multiples of 8.",
                ),
            ],
            outputs=[
                io.Conditioning.Output("positive_out", display_name="positive", tooltip="For the sampler."),
                io.Conditioning.Output("negative_out", display_name="negative", tooltip="For the sampler."),
                io.Latent.Output(display_name="latent", tooltip="Empty, of the clip's size: for the sampler."),
            ],
        )

    @classmethod
    def validate_inputs(
        cls,
        width: int | None = None,
        height: int | None = None,
        length: int | None = None,
        indices: str | None = None,
    ) -> bool | str:
        checks = [] if length is None else [lambda: check_length(length, name="length")]
        if length is not None and indices is not None:
            checks.append(lambda: _places(indices, length))
        return refused_form(*checks, width=width, height=height)

    @classmethod
    def execute(
        cls,
        positive: Any,
        negative: Any,
        vae: Any,
        width: int,
        height: int,
        length: int,
        batch_size: int,
        keyframes: torch.Tensor,
        indices: str,
    ) -> io.NodeOutput:
        import torch

        from ..rendering.control import known_latents, placed_keyframes

        check_length(length, name="length")
        form, at = ModelFormat(length, width, height), _places(indices, length)
        told_size = announce_batch(cls, length, width, height, channels=4)
        pictures = [form.resized(each) for each in pictures_of(keyframes, name="keyframes")]
        clip, _ = placed_keyframes(pictures, at, length)
        scale = vae.spacial_compression_encode()
        rows, columns = height // scale, width // scale
        missing = torch.from_numpy(~known_latents(at, length)).float().T
        shown = {
            "concat_latent_image": vae.encode(torch.from_numpy(clip)),
            "concat_mask": missing[None, :, :, None, None].repeat(1, 1, 1, rows, columns),
        }
        told = ([[tensor, {**more, **shown}] for tensor, more in each] for each in (positive, negative))
        empty = torch.zeros(batch_size, vae.latent_channels, missing.shape[1], rows, columns)
        return io.NodeOutput(*told, {"samples": empty}, ui=told_size or None)


def _places(text: str, length: int) -> list[int]:
    """Frame numbers from 0, in the order in which they were typed.

    Raises:
        InvalidInputError: one is no frame of the clip, or comes twice.
    """
    from ..rendering.control import moments

    typed = whole_numbers_of(text, name="indices")
    moments(typed, length, name="indices")
    return [number % length for number in typed]
