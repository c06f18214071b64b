"""The autoencoder with a temporal decoder: diffusers' own, given weights under either family of names."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING

import torch
from torch import Tensor

if TYPE_CHECKING:
    from diffusers import AutoencoderKLTemporalDecoder

__all__ = ["build_autoencoder", "from_public_autoencoder"]

_LATENT_CHANNELS = 4
_BLOCKS_PER_LEVEL = 2

_RESIDUAL = {
    "norm1": "norm1",
    "conv1": "conv1",
    "norm2": "norm2",
    "conv2": "conv2",
    "nin_shortcut": "conv_shortcut",
    "time_stack.in_layers.0": "norm1",
    "time_stack.in_layers.2": "conv1",
    "time_stack.out_layers.0": "norm2",
    "time_stack.out_layers.3": "conv2",
}
_ATTENTION = {"norm": "group_norm", "q": "to_q", "k": "to_k", "v": "to_v", "proj_out": "to_out.0"}
_ENDS = {
    "norm_out": "conv_norm_out",
    "conv_out.time_mix_conv": "time_conv_out",
}


def build_autoencoder(channels: tuple[int, ...]) -> AutoencoderKLTemporalDecoder:
    """The autoencoder of Stable Video Diffusion.

    Args:
        channels: of each level; (128, 256, 512, 512) in the public one.
    """
    from diffusers import AutoencoderKLTemporalDecoder

    return AutoencoderKLTemporalDecoder(
        down_block_types=("DownEncoderBlock2D",) * len(channels),
        block_out_channels=channels,
        layers_per_block=_BLOCKS_PER_LEVEL,
        latent_channels=_LATENT_CHANNELS,
    )


def from_public_autoencoder(encoder: Mapping[str, Tensor], decoder: Mapping[str, Tensor]) -> dict[str, Tensor]:
    """Weights by diffusers' names.

    Args:
        encoder: by public names, ``encoder.*``, and ``quant_conv.*`` where it is not part of the encoder already.
        decoder: by public names, ``decoder.*``.
    """
    levels = 1 + max(
        (int(found[1]) for name in decoder if (found := re.match(r"decoder\.up\.(\d+)\.", name))), default=0
    )
    named: dict[str, Tensor] = {}
    for name, tensor in [*encoder.items(), *decoder.items()]:
        named[_diffusers_name(name, levels)] = tensor.flatten(1) if _is_attention_matrix(name, tensor) else tensor
    if "quant_conv.weight" not in named:
        named |= _identity(like=next(iter(encoder.values()), torch.zeros(1)))
    return named


def _is_attention_matrix(name: str, tensor: Tensor) -> bool:
    """Public attention is made of 1 x 1 convolutions."""
    return ".attn_1." in name and tensor.ndim == 4


def _identity(like: Tensor) -> dict[str, Tensor]:
    size = 2 * _LATENT_CHANNELS
    weight, bias = torch.eye(size)[:, :, None, None], torch.zeros(size)
    return {"quant_conv.weight": weight.to(like.dtype), "quant_conv.bias": bias.to(like.dtype)}


def _diffusers_name(name: str, levels: int) -> str:
    half, _, rest = name.partition(".")
    place, part = _place(rest, half, levels)
    return f"{half}.{place}{part}" if rest else name


def _place(rest: str, half: str, levels: int) -> tuple[str, str]:
    """Where a tensor lies in its half, and its name there."""
    if found := re.match(r"mid\.block_(\d)\.(.*)", rest):
        return _residual(f"mid_block.resnets.{int(found[1]) - 1}.", found[2], half)
    if found := re.match(r"mid\.attn_1\.(\w+)\.(.*)", rest):
        return "mid_block.attentions.0.", f"{_ATTENTION.get(found[1], found[1])}.{found[2]}"
    if found := re.match(r"(down|up)\.(\d+)\.block\.(\d+)\.(.*)", rest):
        return _residual(f"{_level(found, levels)}resnets.{found[3]}.", found[4], half)
    if found := re.match(r"(down|up)\.(\d+)\.(?:down|up)sample\.(.*)", rest):
        return f"{_level(found, levels)}{found[1]}samplers.0.", found[3]
    layer, _, kind = rest.rpartition(".")
    return "", f"{_ENDS.get(layer, layer)}.{kind}" if layer else rest


def _level(found: re.Match[str], levels: int) -> str:
    """Public decoders count levels from the highest resolution, diffusers' in the order of use."""
    number = int(found[2]) if found[1] == "down" else levels - 1 - int(found[2])
    return f"{found[1]}_blocks.{number}."


def _residual(place: str, part: str, half: str) -> tuple[str, str]:
    if part == "mix_factor":
        return place, "time_mixer.mix_factor"
    layer, _, kind = part.rpartition(".")
    within = ""
    if half == "decoder":
        within = "temporal_res_block." if layer.startswith("time_stack.") else "spatial_res_block."
    return place + within, f"{_RESIDUAL.get(layer, layer)}.{kind}"
