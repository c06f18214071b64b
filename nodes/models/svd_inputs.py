"""The inputs that the choice of the paper's renderer brings to the node Render."""

from __future__ import annotations

from typing import Any

from comfy_api.latest import io

from ...rendering.svd import CLIP_FRAMES, SVDOptions
from ..host import PRECISIONS
from .model_files import lvcd_choices, svd_choices

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
        io.Int.Input(
            "noise_from",
            default=_USUAL.seed,
            min=0,
            max=2**32 - 1,
            tooltip="Seed of the noise: another number gives another clip, the same one the same clip.",
        ),
        io.Int.Input(
            "steps",
            default=_USUAL.steps,
            min=2,
            max=100,
            tooltip="Sampling steps of each segment; time grows with them. 25 is usual, 12 makes drafts.",
        ),
        io.Int.Input(
            "motion_bucket",
            default=_USUAL.motion_bucket,
            min=1,
            max=255,
            tooltip="How much motion the model expects [1 to 255]. Lower keeps the picture calmer.",
        ),
        io.Int.Input(
            "overlap",
            default=_USUAL.overlap,
            min=3,
            max=CLIP_FRAMES // 2,
            tooltip="Frames that neighbouring segments of a long clip share; more hides seams and takes longer.",
        ),
        io.Combo.Input(
            "working_size",
            options=list(AREAS),
            default="576 x 320",
            tooltip="Area that the model works on [px], in the illustration's proportions; trained at 576 x 320.",
        ),
        io.Int.Input(
            "frames_per_second",
            default=_USUAL.frames_per_second,
            min=1,
            max=60,
            tooltip="What the model is told of the frame rate; 6 is what it was trained with. The video's own stays.",
        ),
        io.Float.Input(
            "picture_noise",
            default=_USUAL.picture_noise,
            min=0.0,
            max=1.0,
            step=0.01,
            tooltip="Noise on the illustration [0 to 1]: more lets frames leave it further.",
        ),
        io.Int.Input(
            "decoded_together",
            default=_USUAL.decoded_together,
            min=5,
            max=64,
            tooltip="Frames that are decoded at once; fewer need less memory.",
        ),
        io.Combo.Input(
            "precision",
            options=list(PRECISIONS),
            default=PRECISIONS[0],
            tooltip="auto: 16 bits where the device computes faster with them.",
        ),
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
