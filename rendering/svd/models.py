"""All networks of the renderer by Stable Video Diffusion, loaded from the files that users have."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import torch
from diffusers import AutoencoderKLTemporalDecoder
from torch import Tensor, nn

from ..networks.checkpoints import (
    CheckpointError,
    below,
    build_without_storage,
    check_names,
    network_of,
    read_checkpoint,
)
from ..networks.image_encoder import ImageEncoder
from .autoencoder import build_autoencoder
from .controlnet import SketchControlNet
from .svd_weights import WANTED_SVD, ModelSizes, SVDWeights, read_svd
from .unet import SpatioTemporalUNet

__all__ = ["WANTED_LVCD", "SVDModels", "load_models"]

WANTED_LVCD = (
    "LVCD's lvcd.ckpt from https://huggingface.co/luckyhzt/lvcd_pretrained_models, or lvcd-fp16.safetensors from"
    " https://huggingface.co/Kijai/LVCD-pruned"
)

Network = TypeVar("Network", bound=nn.Module)


@dataclass(frozen=True, eq=False)
class SVDModels:
    """The networks, on the CPU, in the order of their use.

    Attributes:
        image_encoder: embeds the illustration.
        autoencoder: float32; pictures to latents and back.
        control: reads the sketches; None: the networks are Stable Video Diffusion's alone, and read none.
        unet: predicts the frames.
    """

    image_encoder: ImageEncoder
    autoencoder: AutoencoderKLTemporalDecoder
    control: SketchControlNet | None
    unet: SpatioTemporalUNet

    @property
    def dtype(self) -> torch.dtype:
        """In which all but the autoencoder compute."""
        return next(self.unet.parameters()).dtype


def load_models(
    svd: Path, lvcd: Path | None = None, *, dtype: torch.dtype | None = torch.float32, sizes: ModelSizes | None = None
) -> SVDModels:
    """Load all networks. Tensors already in the wanted precision stay mapped from their files.

    Args:
        svd: Stable Video Diffusion: its single file or its diffusers folder.
        lvcd: LVCD's file, .ckpt or .safetensors; None for Stable Video Diffusion alone, which cannot follow sketches.
        dtype: in which all but the autoencoder compute; None leaves weights as their files have them.
        sizes: of the networks in a single file; the public ones by default.

    Raises:
        CheckpointError: a file is missing, damaged or another one; it tells what is wrong and what is wanted.
    """
    weights = read_svd(svd, sizes=sizes)
    network = weights.sizes.network
    control: SketchControlNet | None = None
    attention: dict[str, Tensor] = {}
    if lvcd is not None:
        tensors, attention = _read_lvcd(lvcd, weights.sizes)
        control = network_of(
            lambda: SketchControlNet(network), tensors, dtype=dtype, file=str(lvcd), wanted=WANTED_LVCD
        )
    return SVDModels(
        _loaded(lambda: ImageEncoder(weights.sizes.image_encoder), weights.image_encoder, weights, dtype),
        _loaded(lambda: build_autoencoder(weights.sizes.autoencoder), weights.autoencoder, weights, torch.float32),
        control,
        _loaded(lambda: SpatioTemporalUNet(network), {**weights.unet, **attention}, weights, dtype),
    )


def _loaded(
    build: Callable[[], Network], tensors: Mapping[str, Tensor], weights: SVDWeights, dtype: torch.dtype | None
) -> Network:
    return network_of(build, tensors, dtype=dtype, file=f"{weights.source}", wanted=WANTED_SVD)


def _read_lvcd(path: Path, sizes: ModelSizes) -> tuple[dict[str, Tensor], dict[str, Tensor]]:
    """LVCD's ControlNet, and its attention layers of the UNet; names without prefixes."""
    tensors = read_checkpoint(path, wanted=WANTED_LVCD)
    control, attention = below(tensors, SketchControlNet.prefix), below(tensors, SpatioTemporalUNet.prefix)
    if not control:
        raise CheckpointError(
            f"{path} does not fit: nothing in it is called {SketchControlNet.prefix}*. Wanted: {WANTED_LVCD}"
        )
    unet = build_without_storage(lambda: SpatioTemporalUNet(sizes.network)).state_dict()
    expected = {name: tuple(tensor.shape) for name, tensor in unet.items() if ".attn1." in name or name in attention}
    check_names(
        expected,
        {name: tuple(tensor.shape) for name, tensor in attention.items()},
        file=str(path),
        wanted=WANTED_LVCD,
    )
    return control, attention
