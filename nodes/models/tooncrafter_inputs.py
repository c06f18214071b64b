"""The inputs that the paper's interpolation brings to the node Interpolate."""

from __future__ import annotations

from typing import Any

from comfy_api.latest import io

from ...rendering.tooncrafter import SOLVERS, ToonCrafterOptions
from .clip_inputs import colour_match_input
from .option_inputs import area_input, count_input, precision_input, seed_input
from .tooncrafter_files import model_choices, sketch_model_choices

__all__ = ["AREAS", "tooncrafter_inputs"]

AREAS = {"512 x 320": 512 * 320, "768 x 512": 768 * 512}
"""Areas that the model can work on [px^2]."""

_USUAL = ToonCrafterOptions()


def tooncrafter_inputs() -> list[Any]:
    """The inputs that this choice brings."""
    return [
        io.Image.Input(
            "sketches",
            optional=True,
            tooltip="From Warp Sketch: dark lines on white, one for each frame. Without them nothing leads the model.",
        ),
        io.Combo.Input(
            "tooncrafter_model",
            options=model_choices(),
            tooltip="ToonCrafter: model.ckpt or its pruned fp16 safetensors, in models/checkpoints.",
        ),
        io.Combo.Input(
            "sketch_model",
            options=sketch_model_choices(),
            tooltip="ToonCrafter's sketch_encoder.ckpt, in models/controlnet. Needed only with sketches.",
        ),
        io.Float.Input(
            "control_scale",
            default=_USUAL.control_scale,
            min=0.0,
            max=2.0,
            step=0.05,
            tooltip="How closely in-betweens follow the sketches [0 to 2]. The paper takes 0.1; 0 ignores them.",
        ),
        seed_input(_USUAL, "other in-betweens, the same one the same ones"),
        count_input(
            "steps", _USUAL, 1, 200, "Sampling steps for each pair of keyframes; time grows with them. 50 is usual."
        ),
        io.Combo.Input(
            "solver",
            options=list(SOLVERS),
            default=_USUAL.solver,
            tooltip="ddim: as published, 50 steps. dpm++ 2m: close to it in 15 to 20 steps.",
        ),
        io.Float.Input(
            "guidance",
            default=_USUAL.guidance,
            min=1.0,
            max=30.0,
            step=0.1,
            tooltip="How closely in-betweens follow prompt and keyframes [1 to 30]; 1 takes half the time.",
        ),
        count_input(
            "fs",
            _USUAL,
            1,
            60,
            "What the model is told of the frame rate [1/s]: lower for larger motion. The video's own stays.",
            field="frame_rate",
        ),
        area_input(list(AREAS), next(iter(AREAS)), "the keyframes'", "512 x 320"),
        count_input(
            "pairs_together", _USUAL, 1, 16, "Pairs of keyframes that are drawn at once; fewer need less memory."
        ),
        count_input(
            "decoded_together",
            _USUAL,
            1,
            16,
            "Frames whose pictures are made at once; fewer need less memory, and give the same pictures.",
        ),
        precision_input(),
        io.String.Input(
            "prompt",
            default="",
            tooltip="What happens between the keyframes, in words; usually empty. Words need a clip.",
        ),
        io.Clip.Input(
            "clip",
            optional=True,
            tooltip="Stable Diffusion 2.1's text encoder, from Load CLIP. Left out: the one in model.ckpt.",
        ),
        io.ClipVision.Input(
            "clip_vision",
            optional=True,
            tooltip="CLIP-ViT-H-14, from Load CLIP Vision. Left out: the one in model.ckpt.",
        ),
        colour_match_input("the keyframes before and after"),
    ]
