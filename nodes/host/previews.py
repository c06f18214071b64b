"""What a node shows of its result in the graph itself."""

from __future__ import annotations

import secrets
from typing import TYPE_CHECKING

from comfy_api.latest import io, ui

if TYPE_CHECKING:
    import torch

__all__ = ["animated"]


def animated(frames: torch.Tensor, frame_rate: float) -> ui.SavedImages:
    """A looping preview of a batch, kept in the host's temporary folder.

    Args:
        frames: the host's IMAGE, shape [f, h, w, 3].
        frame_rate: frames a second.
    """
    saved = ui.ImageSaveHelper.save_animated_webp(
        frames,
        filename_prefix=f"physanimator_{secrets.token_hex(4)}",
        folder_type=io.FolderType.temp,
        cls=None,
        fps=frame_rate,
        lossless=False,
        quality=80,
        method=0,
    )
    return ui.SavedImages([saved], is_animated=len(frames) > 1)
