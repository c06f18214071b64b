"""The inputs that Stable Video Diffusion brings to the node Render: led by sketches, the paper's way, or otherwise."""

from __future__ import annotations

from typing import Any

from comfy_api.latest import io

from ...rendering.svd import CLIP_FRAMES, SVDOptions
from .clip_inputs import colour_match_input, loop_input
from .model_files import lvcd_choices, svd_choices
from .option_inputs import area_input, count_input, precision_input, seed_input

__all__ = ["AREAS", "NO_LVCD", "dual_clock_inputs", "svd_inputs"]

AREAS = {"448 x 256": 448 * 256, "576 x 320": 576 * 320, "768 x 448": 768 * 448, "1024 x 576": 1024 * 576}
NO_LVCD = "none"
"""What stands for no LVCD file."""

_USUAL, _FROM_ANIMATION = SVDOptions(), SVDOptions.following("animation")


def svd_inputs() -> list[Any]:
    """The inputs of the choice that follows sketches."""
    return [
        io.Image.Input("sketches", tooltip="From Warp Sketch: dark lines on white, one for each frame of the motion."),
        _svd_model(),
        io.Combo.Input(
            "lvcd_model",
            options=lvcd_choices(),
            tooltip="LVCD: lvcd.ckpt or lvcd-fp16.safetensors in models/controlnet, models/checkpoints or models/lvcd.",
        ),
        *_of_sampler(_USUAL),
        *_of_clip(),
    ]


def dual_clock_inputs() -> list[Any]:
    """The inputs of the choice that follows the animation, and sketches as well where they are given."""
    return [
        _svd_model(),
        io.Float.Input(
            "weak",
            default=_FROM_ANIMATION.weak,
            min=0.0,
            max=1.0,
            step=0.01,
            tooltip="Part of the steps that the animation stands in for [0 to 1]. Lower repaints more, everywhere.",
        ),
        io.Float.Input(
            "strong",
            default=_FROM_ANIMATION.strong,
            min=0.0,
            max=1.0,
            step=0.01,
            tooltip="Part of the steps until which moving parts are held to the animation [weak to 1]. Too low: they"
            " leave its path. Too high: they stay as stiff as they are there.",
        ),
        io.Float.Input(
            "guidance",
            default=_FROM_ANIMATION.guidance,
            min=1.0,
            max=10.0,
            step=0.1,
            tooltip="How strongly the last frame of each segment holds to the illustration [1 to 10]; 1 takes half the"
            " time. Not used with sketches.",
        ),
        *_of_sampler(_FROM_ANIMATION),
        io.Image.Input(
            "sketches",
            optional=True,
            tooltip="From Warp Sketch, to follow its lines as well; choose lvcd_model then. Without them Stable Video"
            " Diffusion is enough.",
        ),
        io.Combo.Input(
            "lvcd_model",
            options=[NO_LVCD, *lvcd_choices()],
            default=NO_LVCD,
            tooltip="Needed only with sketches: lvcd.ckpt or lvcd-fp16.safetensors in models/controlnet,"
            " models/checkpoints or models/lvcd.",
        ),
        *_of_clip(),
    ]


def _of_clip() -> list[Any]:
    """How a clip ends, and which colours it has."""
    return [
        loop_input("the last frames lead to the first, for which up to one segment more is drawn"),
        colour_match_input("composite outside holes, or of the illustration where no motion is connected"),
    ]


def _svd_model() -> io.Combo.Input:
    return io.Combo.Input(
        "svd_model",
        options=svd_choices(),
        tooltip="Stable Video Diffusion, image to video, 14 frames: svd.safetensors in models/checkpoints, or its"
        " diffusers folder in models/diffusers.",
    )


def _of_sampler(usual: SVDOptions) -> list[Any]:
    """What any clip needs to be told.

    Args:
        usual: settings that stand there at first.
    """
    return [
        seed_input(usual, "another clip, the same one the same clip"),
        count_input(
            "steps",
            usual,
            2,
            100,
            "Sampling steps of each segment; time grows with them. 25 is usual, 12 makes drafts.",
        ),
        count_input(
            "motion_bucket",
            usual,
            1,
            255,
            "How much motion the model expects [1 to 255]. Lower keeps the picture calmer.",
        ),
        count_input(
            "overlap",
            usual,
            3,
            CLIP_FRAMES // 2,
            "Frames that neighbouring segments of a long clip share; more hides seams and takes longer.",
        ),
        area_input(list(AREAS), "576 x 320", "the illustration's", "576 x 320"),
        count_input(
            "frames_per_second",
            usual,
            1,
            60,
            "What the model is told of the frame rate; 6 is what it was trained with. The video's own stays.",
        ),
        io.Float.Input(
            "picture_noise",
            default=usual.picture_noise,
            min=0.0,
            max=1.0,
            step=0.01,
            tooltip="Noise on the illustration [0 to 1]: more lets frames leave it further.",
        ),
        count_input("decoded_together", usual, 5, 64, "Frames that are decoded at once; fewer need less memory."),
        precision_input(),
        io.Boolean.Input(
            "keep_still_parts",
            default=True,
            tooltip="Takes all pixels that no body ever covers from the illustration.",
        ),
        io.Float.Input(
            "soft_edge",
            default=24.0,
            min=0.0,
            max=1000.0,
            step=1.0,
            tooltip="Width of the transition to the kept pixels [px].",
        ),
    ]
