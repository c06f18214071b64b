"""Latents of the animation that frames follow, and the latent cells in which something moves."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from ...physics.errors import require
from ..networks import Frame
from ..networks.memory import autoencoder_bytes
from ..networks.placement import Placement
from ..pictures import as_float, as_picture
from .crude_animation import CrudeAnimation
from .models import SVDModels
from .sampler import LATENT_SCALE

__all__ = ["PIXELS_PER_LATENT", "encode_animation", "latent_mask"]

PIXELS_PER_LATENT = 8
"""Side of the square of pixels that one latent cell stands for [px]."""

_LEAST_COVERAGE = 0.1
"""Less than this is not seen as a part of its own; thin strands between pixels cover more."""


@torch.no_grad()
def encode_animation(
    animation: CrudeAnimation,
    frame: Frame,
    models: SVDModels,
    *,
    placement: Placement,
    each: Callable[[], None] = lambda: None,
) -> tuple[Tensor, Tensor]:
    """Latents of all frames, and where something moves in them.

    Args:
        animation: whose frames are encoded, one after another.
        frame: in which the networks see pictures.
        models: whose autoencoder is used.
        placement: where to compute.
        each: called after each frame; may raise to stop.

    Returns:
        Latents, scaled as the sampler's are, float32, shape [f, 4, h, w], and a bool mask, shape [f, 1, h, w], on the
        device.

    Raises:
        InvalidInputError: a frame is not of the illustration's size.
    """
    channels = models.autoencoder.config.block_out_channels[0]
    latents, masks = [], []
    with placement.at_work(
        models.autoencoder, working_bytes=autoencoder_bytes(frame.size[0] * frame.size[1], channels)
    ):
        for number in range(animation.count):
            picture, coverage = animation.at(number)
            _check_size(picture, coverage, frame, number)
            inward = torch.from_numpy(frame.inward(as_float(as_picture(picture)))).permute(2, 0, 1)[None].contiguous()
            encoded = models.autoencoder.encode((2 * inward - 1).to(placement.device)).latent_dist.mode()
            latents.append(LATENT_SCALE * encoded)
            masks.append(torch.from_numpy(latent_mask(coverage, frame)))
            each()
    return torch.cat(latents), torch.stack(masks)[:, None].to(placement.device)


def latent_mask(coverage: NDArray[Any], frame: Frame) -> NDArray[np.bool_]:
    """Latent cells that moving parts are seen in: the largest coverage of any pixel that touches a cell counts.

    Args:
        coverage: how much of each pixel they cover, 0..1, shape [h, w].
        frame: in which the networks see pictures.

    Returns:
        Shape [frame's height / 8, frame's width / 8].
    """
    return frame.cells_touched(np.asarray(coverage) >= _LEAST_COVERAGE, cell=PIXELS_PER_LATENT)


def _check_size(picture: NDArray[Any], coverage: NDArray[Any], frame: Frame, number: int) -> None:
    wanted = f"of the illustration's size, {frame.width} x {frame.height} px"
    for name, given in (("animation", picture), ("coverage", coverage)):
        height, width = given.shape[:2]
        got = f"{width} x {height} px in frame {number}"
        require(name, got, (width, height) == (frame.width, frame.height), wanted)
