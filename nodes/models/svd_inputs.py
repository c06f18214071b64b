"""The inputs that the choice of the paper's renderer brings to the node Render."""

from __future__ import annotations

from typing import Any

from comfy_api.latest import io

from ...rendering.svd import CLIP_FRAMES, SVDOptions
from .clip_inputs import colour_match_input, loop_input
from .model_files import lvcd_choices, svd_choices
from .option_inputs import area_input, count_input, precision_input, seed_input

__all__ = ["AREAS", "svd_inputs"]

AREAS = {"448 x 256": 448 * 256, "576 x 320": 576 * 320, "768 x 448": 768 * 448, "1024 x 576": 1024 * 576}
_USUAL = SVDOptions()


def svd_inputs() -> list[Any]:
    """The inputs that this choice brings."""
    return [
        io.Image.Input("sketches", tooltip="From Warp Sketch: dark lines on white, one for each frame of the motion."),
        io.Combo.Input(
            "svd_model",
            options=svd_choices(),
            tooltip="Stable Video Diffusion, image to video, 14 frames: svd.safetensors in models/checkpoints, or its"
            " diffusers folder in models/diffusers.",
        ),
        io.Combo.Input(
            "lvcd_model",
            options=lvcd_choices(),
            tooltip="LVCD: lvcd.ckpt or lvcd-fp16.safetensors in models/controlnet, models/checkpoints or models/lvcd.",
        ),
        seed_input(_USUAL, "another clip, the same one the same clip"),
        count_input(
            "steps",
            _USUAL,
            2,
            100,
            "Sampling steps of each segment; time grows with them. 25 is usual, 12 makes drafts.",
        ),
        count_input(
            "motion_bucket",
            _USUAL,
            1,
            255,
            "How much motion the model expects [1 to 255]. Lower keeps the picture calmer.",
        ),
        count_input(
            "overlap",
            _USUAL,
            3,
            CLIP_FRAMES // 2,
            "Frames that neighbouring segments of a long clip share; more hides seams and takes longer.",
        ),
        area_input(list(AREAS), "576 x 320", "the illustration's", "576 x 320"),
        count_input(
            "frames_per_second",
            _USUAL,
            1,
            60,
            "What the model is told of the frame rate; 6 is what it was trained with. The video's own stays.",
        ),
        io.Float.Input(
            "picture_noise",
            default=_USUAL.picture_noise,
            min=0.0,
            max=1.0,
            step=0.01,
            tooltip="Noise on the illustration [0 to 1]: more lets frames leave it further.",
        ),
        count_input("decoded_together", _USUAL, 5, 64, "Frames that are decoded at once; fewer need less memory."),
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
        loop_input("the last frames lead to the first, for which up to one segment more is drawn"),
        colour_match_input("composite outside holes, or of the illustration where no motion is connected"),
    ]
