"""Line drawing networks from files: which network it is, is read off the names of its tensors."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import torch
from torch import Tensor

from ...networks.checkpoints import below, read_checkpoint
from .configuration import InformativeDrawingsConfiguration, SketchUNetConfiguration
from .files import WANTED
from .informative_drawings import InformativeDrawings
from .sketch_unet import SketchUNet

__all__ = ["LineDrawer", "load_drawer"]

LineDrawer = InformativeDrawings | SketchUNet

_PARALLEL = "module."
"""What training on several devices puts before every name."""


def load_drawer(path: Path, *, dtype: torch.dtype = torch.float32) -> LineDrawer:
    """The network whose weights a file holds, on the CPU.

    Args:
        path: .pth, .pt, .bin, .ckpt or .safetensors with a plain state dict.
        dtype: of the weights.

    Raises:
        CheckpointError: the file is missing, damaged, holds more than data, or another network's weights; the
            message names missing and surplus tensors.
    """
    tensors = read_checkpoint(path, wanted=WANTED)
    if all(name.startswith(_PARALLEL) for name in tensors):
        tensors = below(tensors, _PARALLEL)
    drawer: LineDrawer
    if any(name.startswith("model.model.") for name in tensors):
        drawer = SketchUNet.from_reference(SketchUNetConfiguration(), tensors, file=str(path), wanted=WANTED)
    else:
        sizes = InformativeDrawingsConfiguration(n_residual_blocks=_residual_blocks(tensors))
        drawer = InformativeDrawings.from_reference(sizes, tensors, file=str(path), wanted=WANTED)
    return drawer.to(dtype)


def _residual_blocks(tensors: Mapping[str, Tensor]) -> int:
    """As many as the names count, and at least those of the public weights, so that lost ones are missed."""
    found = (re.match(r"model2\.(\d+)\.", name) for name in tensors)
    last = max((int(each[1]) for each in found if each), default=0)
    return max(last + 1, InformativeDrawingsConfiguration.n_residual_blocks)
