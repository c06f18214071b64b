"""What a node shows of its result in the graph itself."""

from __future__ import annotations

import secrets
from typing import TYPE_CHECKING, Any

from comfy_api.latest import io, ui

from .tensors import batch_of_pictures

if TYPE_CHECKING:
    import torch
    from numpy.typing import NDArray

__all__ = ["animated", "saved_picture"]


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


def saved_picture(picture: NDArray[Any]) -> dict[str, Any]:
    """Where the host keeps a picture for its page to fetch: RGB or straight RGBA, shape [h, w, 3] or [h, w, 4]."""
    saved = ui.ImageSaveHelper.save_images(
        batch_of_pictures([picture], 1),
        filename_prefix=f"physanimator_{secrets.token_hex(4)}",
        folder_type=io.FolderType.temp,
        cls=None,
        compress_level=1,
    )
    return dict(saved[0])
