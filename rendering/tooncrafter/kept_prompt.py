"""The empty prompt's embedding, kept beside the model's file, so that later runs need no text encoder.

The file's ending is its own, because programs that list models by their endings shall not offer it as one.
"""

from __future__ import annotations

import contextlib
from pathlib import Path

from safetensors import SafetensorError
from safetensors.torch import load_file, save_file
from torch import Tensor

from ...physics.errors import InvalidInputError
from ..files import replacing

__all__ = ["keep_prompt", "kept_prompt", "kept_prompt_file"]

_NAME = "empty_prompt"


def kept_prompt_file(model: Path) -> Path:
    """Where the embedding for a model's file is kept."""
    return model.with_name(f"{model.name}.{_NAME}")


def kept_prompt(model: Path, shape: tuple[int, ...]) -> Tensor | None:
    """The embedding that was kept, in full precision.

    Args:
        model: the model's file.
        shape: that it must have, [1, l, c].

    Returns:
        None where there is none of that shape, or where the model's file has been replaced since.
    """
    file = kept_prompt_file(model)
    try:
        if file.stat().st_mtime < model.stat().st_mtime:
            return None
        found = load_file(file).get(_NAME)
    except (OSError, SafetensorError):
        return None
    return found if found is not None and tuple(found.shape) == shape else None


def keep_prompt(model: Path, embedding: Tensor) -> None:
    """Keep the embedding, shape [1, l, c], for later runs; where the folder cannot be written to, nothing is kept."""
    with contextlib.suppress(OSError, SafetensorError, InvalidInputError), replacing(kept_prompt_file(model)) as file:
        save_file({_NAME: embedding.detach().float().cpu().contiguous()}, file)
