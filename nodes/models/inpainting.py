"""Soft inpainting as a choice of the node Render: what it paints, on the host's device."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, counted, require
from ...rendering.composite import Background
from ...rendering.inpainting import InpaintingOptions
from ...rendering.neural.soft_inpainting import Change, changes_of_holes, painted_frames
from ..host import dtype_of, host_progress, mask_of, refusal
from .inpainting_files import inpainting_folder, missing_inpainting_model
from .inpainting_inputs import INPAINTING_AREAS
from .networks import kept_networks

if TYPE_CHECKING:
    from ...rendering.composite import LayeredRenderer

__all__ = ["inpainted_frames", "refused_inpainting"]

FloatImage = NDArray[np.float32]


def inpainted_frames(layers: LayeredRenderer, background: Background, choice: dict[str, Any]) -> Iterator[FloatImage]:
    """The frames of the composite with their holes painted.

    Args:
        layers: draws the motion.
        background: opaque.
        choice: values of the inputs.

    Raises:
        InvalidInputError: the model is missing or another one, or nothing is there to be painted.
    """
    from comfy import model_management

    from ...rendering.inpainting.models import load_inpainting_models

    change = _change(layers, choice)
    folder = inpainting_folder(choice["inpainting_model"])
    if folder is None:
        raise InvalidInputError(missing_inpainting_model(choice["inpainting_model"]))
    device = model_management.get_torch_device()
    dtype, options = dtype_of(choice["precision"], device), _options(choice)
    key = folder, _changed(folder), dtype
    networks = kept_networks("soft inpainting", key, lambda: load_inpainting_models(folder, dtype=dtype))
    return painted_frames(
        networks.held,
        layers,
        background,
        change,
        options=options,
        placement=networks.placement(device),
        numbers=range(len(layers)),
        progress=host_progress(),
    )


def refused_inpainting(choice: dict[str, Any]) -> str:
    """What is wrong with the choice before anything is computed; empty if nothing is, or another renderer is chosen.

    Args:
        choice: values of the inputs; those that come from other nodes are missing.
    """
    name, strength, steps = (choice.get(each) for each in ("inpainting_model", "strength", "steps"))
    if not name or inpainting_folder(name) is None:
        return missing_inpainting_model(name) if name else ""
    if strength is None or steps is None:
        return ""
    said = refusal(lambda: InpaintingOptions(strength=strength, steps=steps))
    return "" if said is True else str(said)


def _options(choice: dict[str, Any]) -> InpaintingOptions:
    same = ("prompt", "negative_prompt", "steps", "strength", "guidance", "shared_noise")
    chosen = {name: choice[name] for name in same}
    return InpaintingOptions(area=INPAINTING_AREAS[choice["working_size"]], seed=choice["noise_from"], **chosen)


def _change(layers: LayeredRenderer, choice: dict[str, Any]) -> Change:
    """How much each pixel may change, by the number and the alpha of a frame."""
    given = choice.get("change")
    if given is None:
        if layers.drawn_plate:
            raise InvalidInputError(
                "change must be connected where a clean_plate or layers say what is behind the parts. Got: nothing"
            )
        return changes_of_holes(layers, grow=choice["grow"], soft_edge=choice["soft_edge"])
    count, frames = given.shape[0] if given.ndim == 3 else 1, len(layers)
    require("change", counted(count, "mask"), count in (1, frames), f"one mask, or one for each of {frames} frames")
    got, size = mask_of(given, name="change").shape, layers.plate.shape[:2]
    expected = f"of the illustration's size, {size[1]} x {size[0]} px"
    require("change", f"{got[1]} x {got[0]} px", got == size, expected)
    return lambda number, _: mask_of(given, index=number % count, name="change")


def _changed(folder: Path) -> float:
    """When the newest of a model's files was written."""
    return max(file.stat().st_mtime for part in folder.iterdir() if part.is_dir() for file in part.iterdir())
