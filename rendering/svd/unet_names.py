"""From diffusers' names of the Stable Video Diffusion UNet to the public checkpoint's, which our network uses."""

from __future__ import annotations

import re
from collections.abc import Mapping

from torch import Tensor

from .configuration import NetworkConfiguration

__all__ = ["from_diffusers_unet"]

_RESIDUAL = {
    "norm1": "in_layers.0",
    "conv1": "in_layers.2",
    "time_emb_proj": "emb_layers.1",
    "norm2": "out_layers.0",
    "conv2": "out_layers.3",
    "conv_shortcut": "skip_connection",
}
_ENDS = {
    "conv_in": "input_blocks.0.0",
    "time_embedding.linear_1": "time_embed.0",
    "time_embedding.linear_2": "time_embed.2",
    "add_embedding.linear_1": "label_emb.0.0",
    "add_embedding.linear_2": "label_emb.0.2",
    "conv_norm_out": "out.0",
    "conv_out": "out.2",
}
_TRANSFORMER = (
    ("temporal_transformer_blocks.", "time_stack."),
    ("time_pos_embed.linear_1.", "time_pos_embed.0."),
    ("time_pos_embed.linear_2.", "time_pos_embed.2."),
)


def from_diffusers_unet(tensors: Mapping[str, Tensor], config: NetworkConfiguration) -> dict[str, Tensor]:
    """The same weights by public names, without prefix; a name that is not understood stays."""
    return {_public_name(name, config): tensor for name, tensor in tensors.items()}


def _public_name(name: str, config: NetworkConfiguration) -> str:
    blocks, levels = config.num_res_blocks, len(config.channel_mult)
    if found := re.match(r"mid_block\.(resnets|attentions)\.(\d)\.(.*)", name):
        if found[1] == "attentions":
            return f"middle_block.1.{_in_transformer(found[3])}"
        return f"middle_block.{2 * int(found[2])}.{_in_residual(found[3])}"
    if found := re.match(r"(down|up)_blocks\.(\d+)\.(resnets|attentions)\.(\d+)\.(.*)", name):
        step = (blocks + 1) * int(found[2]) + int(found[4])
        stage = f"input_blocks.{1 + step}" if found[1] == "down" else f"output_blocks.{step}"
        attends = found[3] == "attentions"
        return f"{stage}.1.{_in_transformer(found[5])}" if attends else f"{stage}.0.{_in_residual(found[5])}"
    if found := re.match(r"down_blocks\.(\d+)\.downsamplers\.0\.conv\.(.*)", name):
        return f"input_blocks.{(blocks + 1) * (int(found[1]) + 1)}.0.op.{found[2]}"
    if found := re.match(r"up_blocks\.(\d+)\.upsamplers\.0\.conv\.(.*)", name):
        number = int(found[1])
        place = 2 if levels - 1 - number in config.attention_at_levels else 1
        return f"output_blocks.{(blocks + 1) * number + blocks}.{place}.conv.{found[2]}"
    layer, _, kind = name.rpartition(".")
    return f"{_ENDS.get(layer, layer)}.{kind}"


def _in_residual(part: str) -> str:
    block, _, rest = part.partition(".")
    if block == "time_mixer":
        return part
    layer, _, kind = rest.rpartition(".")
    return f"{'time_stack.' if block == 'temporal_res_block' else ''}{_RESIDUAL.get(layer, layer)}.{kind}"


def _in_transformer(part: str) -> str:
    for theirs, ours in _TRANSFORMER:
        part = part.replace(theirs, ours)
    return part
