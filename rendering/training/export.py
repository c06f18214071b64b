"""From a checkpoint of a training to one file that the nodes load as they load the public ones."""

from __future__ import annotations

import json
from pathlib import Path

import torch
from safetensors.torch import save_file

from ... import __version__
from ...physics.errors import InvalidInputError, require
from ..files import check_file_place, replacing
from .checkpoints import read_checkpoint_folder
from .settings import KINDS

__all__ = ["export_checkpoint"]

_PRECISIONS = {"fp32": torch.float32, "fp16": torch.float16, "bf16": torch.bfloat16}


def export_checkpoint(checkpoint: Path, output: Path, *, dtype: str = "fp16", average: bool | None = None) -> str:
    """Write the trained weights under the public checkpoint's names.

    Args:
        checkpoint: folder of a checkpoint.
        output: the .safetensors file.
        dtype: fp32, fp16 or bf16.
        average: whether the moving average is written; where one is kept, when None.

    Returns:
        What was trained: ``lvcd`` or ``tooncrafter``.

    Raises:
        InvalidInputError: the checkpoint is not whole, has no average, or the place cannot be written.
    """
    require("dtype", dtype, dtype in _PRECISIONS, f"one of {', '.join(_PRECISIONS)}")
    suffix = output.suffix.lower()
    require("output", output.name, suffix == ".safetensors", "a name that ends in .safetensors")
    check_file_place(output)
    found = read_checkpoint_folder(checkpoint)
    kind = str(found.state.get("kind"))
    require("checkpoint", kind, kind in KINDS, f"of a training of {' or '.join(KINDS)}")
    if average and not found.average:
        raise InvalidInputError(f"checkpoint must have a moving average to export it. Got: {checkpoint}, without one")
    chosen = found.average if (found.average and average is not False) else found.trained
    settings = found.state.get("settings", {})
    told = {
        "format": "pt",
        "physanimator.version": __version__,
        "physanimator.trained": kind,
        "physanimator.steps": str(found.state["step"]),
        "physanimator.average": "yes" if chosen is found.average else "no",
        "physanimator.data": Path(str(settings.get("data", ""))).name,
        "physanimator.blur": json.dumps([settings.get("least_blur"), settings.get("most_blur")]),
        "physanimator.licence": str(settings.get("licence", "")),
    }
    with replacing(output) as temporary:
        save_file(
            {name: each.to(_PRECISIONS[dtype]).contiguous() for name, each in chosen.items()}, temporary, metadata=told
        )
    return kind
