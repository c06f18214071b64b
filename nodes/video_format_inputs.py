"""Inputs and outputs that nodes for video models share: length and size of the clip."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..physics.motion import FITS
from ..rendering.control import FRAME_STEP, SIZE_STEP, ModelFormat
from .host import picture_of, refusal

if TYPE_CHECKING:
    from collections.abc import Callable

    import torch

    from .host.wires import MaskedMotion

__all__ = [
    "form_outputs",
    "form_values",
    "given_plate",
    "length_input",
    "plate_input",
    "refused_form",
    "size_inputs",
]

_USUAL = ModelFormat()


def length_input() -> Any:
    """The input frames."""
    return io.Int.Input(
        "frames",
        default=_USUAL.frames,
        min=1,
        max=10_001,
        step=FRAME_STEP,
        tooltip="Over the whole motion, from its first frame to its last; 4 k + 1 [frames], as in the model's node.",
    )


def size_inputs() -> list[Any]:
    """The inputs width, height and fit."""
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


def refused_form(*checks: Callable[[], Any], **form: int | None) -> bool | str:
    """Why typed numbers are refused before the graph runs, or True: what ``validate_inputs`` gives.

    Args:
        checks: of other inputs; each raises when a value is unusable.
        form: frames, width and height, as far as they are inputs; None where another node gives the number.
    """
    typed = {name: value for name, value in form.items() if value is not None}
    return refusal(lambda: ModelFormat(**typed), *checks)


def plate_input() -> Any:
    """The optional input clean_plate."""
    return io.Image.Input(
        "clean_plate",
        optional=True,
        tooltip="The picture without the moving parts, if you have it. Painted automatically when left out.",
    )


def form_outputs() -> list[Any]:
    """Outputs that tell the model's node its numbers."""
    return [
        io.Int.Output("out_width", display_name="width", tooltip="For the model's node [px]."),
        io.Int.Output("out_height", display_name="height", tooltip="For the model's node [px]."),
        io.Int.Output("out_length", display_name="length", tooltip="For the model's node [frames]."),
        io.Float.Output("frame_rate", display_name="frame_rate", tooltip="For Create Video [frames/s]."),
    ]


def given_plate(plate: torch.Tensor | None) -> Any:
    """The picture of the input clean_plate, None where nothing is connected."""
    return None if plate is None else picture_of(plate, name="clean_plate")


def form_values(form: ModelFormat, motion: MaskedMotion) -> tuple[int, int, int, float]:
    """What stands at these outputs."""
    rate = motion.motion.frame_rate * (form.frames - 1) / max(1, len(motion.motion) - 1)
    return form.width, form.height, form.frames, rate
