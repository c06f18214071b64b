"""The inputs that the choice of soft inpainting brings to the node Render."""

from __future__ import annotations

from typing import Any

from comfy_api.latest import io

from ...rendering.inpainting import InpaintingOptions
from ..host import PRECISIONS
from .inpainting_files import inpainting_choices

__all__ = ["INPAINTING_AREAS", "inpainting_inputs"]

INPAINTING_AREAS = {"own size": None, "512 x 512": 512**2, "768 x 768": 768**2, "1024 x 1024": 1024**2}
_USUAL = InpaintingOptions()


def inpainting_inputs() -> list[Any]:
    """The inputs that this choice brings."""
    return [
        io.Combo.Input(
            "inpainting_model",
            options=inpainting_choices(),
            tooltip="A folder of Stable Diffusion 1 or 2 in models/diffusers, best one for inpainting.",
        ),
        io.String.Input(
            "prompt",
            default="",
            multiline=True,
            tooltip="What is to be seen in the whole picture, such as: girl with long hair, clean lines, flat colours.",
        ),
        io.String.Input("negative_prompt", default="", multiline=True, tooltip="What is not to be seen."),
        io.Float.Input(
            "strength",
            default=_USUAL.strength,
            min=0.05,
            max=1.0,
            step=0.05,
            tooltip="How far holes may leave what composite shows there [0.05 to 1]; 1 paints them anew.",
        ),
        io.Int.Input(
            "steps",
            default=_USUAL.steps,
            min=1,
            max=200,
            tooltip="Sampling steps of each frame at strength 1; less strength does that share of them.",
        ),
        io.Float.Input(
            "guidance",
            default=_USUAL.guidance,
            min=0.0,
            max=30.0,
            step=0.5,
            tooltip="How closely the prompt is followed; 1 leaves negative_prompt out and takes half the time.",
        ),
        io.Int.Input(
            "noise_from",
            default=_USUAL.seed,
            min=0,
            max=2**32 - 1,
            tooltip="Seed of the noise: another number paints something else, the same one the same.",
        ),
        io.Boolean.Input(
            "shared_noise",
            default=_USUAL.shared_noise,
            tooltip="All frames start from the same noise, so that what is painted flickers less.",
        ),
        io.Float.Input(
            "grow",
            default=4.0,
            min=0.0,
            max=1000.0,
            step=1.0,
            tooltip="How far holes reach beyond what the parts have uncovered [px].",
        ),
        io.Float.Input(
            "soft_edge",
            default=16.0,
            min=0.0,
            max=1000.0,
            step=1.0,
            tooltip="Width of the transition around holes, in which the frame is changed less and less [px].",
        ),
        io.Combo.Input(
            "working_size",
            options=list(INPAINTING_AREAS),
            default="own size",
            tooltip="Area that the model works on [px], in the illustration's proportions. Smaller is faster and takes"
            " less memory, and what it paints is less sharp.",
        ),
        io.Combo.Input(
            "precision",
            options=list(PRECISIONS),
            default=PRECISIONS[0],
            tooltip="auto: 16 bits where the device computes faster with them.",
        ),
        io.Mask.Input(
            "change",
            optional=True,
            tooltip="How much each pixel may change, white fully, black not at all: one mask, or one for each frame."
            " Left out, holes with soft edges.",
        ),
    ]
