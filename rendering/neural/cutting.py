"""Who cuts parts out at points: the segmenter that is chosen."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import torch

from .devices import device_of, dtype_of
from .options import NetworkOptions

if TYPE_CHECKING:
    from ..segmentation.sam.segmenter import SamSegmenter

__all__ = ["segmenter_of"]


def segmenter_of(options: NetworkOptions) -> SamSegmenter | None:
    """The Segment Anything network on its device; None where none is chosen.

    Raises:
        CheckpointError: the file or folder cannot be used.
        InvalidInputError: there is no such device.
    """
    if options.segmenter != "sam" or options.sam is None:
        return None
    from ..segmentation.sam.segmenter import SamSegmenter

    device = device_of(options.device)
    dtype = torch.float32 if options.dtype == "auto" else dtype_of(options.dtype, device)
    return SamSegmenter.load(Path(options.sam), device=device, dtype=dtype)
