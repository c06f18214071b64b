"""SAM's weights under their authors' names: the names that transformers gives them, and the sizes they tell."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from torch import Tensor

from ...networks.checkpoints import CheckpointError

__all__ = ["sam_config", "sam_names"]

_RENAMED = (
    (r"^image_encoder\.neck\.0\.", "vision_encoder.neck.conv1."),
    (r"^image_encoder\.neck\.1\.", "vision_encoder.neck.layer_norm1."),
    (r"^image_encoder\.neck\.2\.", "vision_encoder.neck.conv2."),
    (r"^image_encoder\.neck\.3\.", "vision_encoder.neck.layer_norm2."),
    (r"^image_encoder\.patch_embed\.proj\.", "vision_encoder.patch_embed.projection."),
    (r"^image_encoder\.blocks\.(\d+)\.norm", r"vision_encoder.layers.\1.layer_norm"),
    (r"^image_encoder\.blocks\.", "vision_encoder.layers."),
    (r"^image_encoder\.", "vision_encoder."),
    (
        r"^prompt_encoder\.pe_layer\.positional_encoding_gaussian_matrix$",
        "shared_image_embedding.positional_embedding",
    ),
    (r"^prompt_encoder\.point_embeddings\.", "prompt_encoder.point_embed."),
    (r"^prompt_encoder\.mask_downscaling\.0\.", "prompt_encoder.mask_embed.conv1."),
    (r"^prompt_encoder\.mask_downscaling\.1\.", "prompt_encoder.mask_embed.layer_norm1."),
    (r"^prompt_encoder\.mask_downscaling\.3\.", "prompt_encoder.mask_embed.conv2."),
    (r"^prompt_encoder\.mask_downscaling\.4\.", "prompt_encoder.mask_embed.layer_norm2."),
    (r"^prompt_encoder\.mask_downscaling\.6\.", "prompt_encoder.mask_embed.conv3."),
    (r"^mask_decoder\.output_upscaling\.0\.", "mask_decoder.upscale_conv1."),
    (r"^mask_decoder\.output_upscaling\.1\.", "mask_decoder.upscale_layer_norm."),
    (r"^mask_decoder\.output_upscaling\.3\.", "mask_decoder.upscale_conv2."),
    (r"^(mask_decoder\.transformer\.(?:.*\.)?)norm(\d|_final_attn)\.", r"\1layer_norm\2."),
)
_PERCEPTRON = re.compile(
    r"^(mask_decoder\.(?:output_hypernetworks_mlps\.\d+|iou_prediction_head))\.layers\.(\d+)\.(.*)$"
)


def sam_names(tensors: Mapping[str, Tensor]) -> dict[str, Tensor]:
    """The tensors of a SAM file under the names that transformers uses; those that bear them already stay.

    Args:
        tensors: by their names in the file.
    """
    if not any(name.startswith("image_encoder.") for name in tensors):
        return dict(tensors)
    depths: dict[str, int] = {}
    for match in filter(None, map(_PERCEPTRON.match, tensors)):
        depths[match[1]] = max(depths.get(match[1], 0), int(match[2]))
    return {_renamed(name, depths): tensor for name, tensor in tensors.items() if not name.startswith("pixel_")}


def _renamed(name: str, depths: Mapping[str, int]) -> str:
    perceptron = _PERCEPTRON.match(name)
    if perceptron:
        head, layer, rest = perceptron[1], int(perceptron[2]), perceptron[3]
        inner = "proj_in" if layer == 0 else "proj_out" if layer == depths[head] else f"layers.{layer - 1}"
        return f"{head}.{inner}.{rest}"
    for pattern, replacement in _RENAMED:
        name, found = re.subn(pattern, replacement, name)
        if found:
            return name
    return name


def sam_config(tensors: Mapping[str, Tensor], *, file: str, wanted: str) -> dict[str, Any]:
    """The sizes of a SAM network, read off its tensors' shapes.

    Args:
        tensors: by the names that transformers uses.
        file: where they come from, for messages.
        wanted: which file this should be, for messages.

    Returns:
        What ``SamConfig`` takes.

    Raises:
        CheckpointError: these are not SAM's weights.
    """
    try:
        return _sizes(tensors)
    except (KeyError, ValueError) as error:
        raise CheckpointError(f"{file} does not hold SAM's weights ({error} is missing). Wanted: {wanted}") from error


def _sizes(tensors: Mapping[str, Tensor]) -> dict[str, Any]:
    vision, decoder = "vision_encoder.", "mask_decoder."
    _, grid, _, width = tensors[vision + "pos_embed"].shape
    patch = tensors[vision + "patch_embed.projection.weight"].shape[-1]
    depth = _count(tensors, vision + r"layers\.(\d+)\.")
    # A relative position table of length 2 n - 1 belongs to attention within windows of n patches.
    tables = [tensors[f"{vision}layers.{layer}.attn.rel_pos_h"] for layer in range(depth)]
    windows = [(len(table) + 1) // 2 for table in tables]
    features = tensors["shared_image_embedding.positional_embedding"].shape[1]
    channels = tensors[decoder + "iou_token.weight"].shape[1]
    head = decoder + "iou_prediction_head."
    square = {"image_size": grid * patch, "patch_size": patch}
    return {
        "vision_config": square
        | {
            "hidden_size": width,
            "output_channels": tensors[vision + "neck.conv1.weight"].shape[0],
            "num_hidden_layers": depth,
            "num_attention_heads": width // tables[0].shape[1],
            "mlp_dim": tensors[vision + "layers.0.mlp.lin1.weight"].shape[0],
            "window_size": min(windows),
            "global_attn_indexes": [layer for layer, window in enumerate(windows) if window == grid],
            "num_pos_feats": features,
        },
        "prompt_encoder_config": square
        | {
            "hidden_size": channels,
            "mask_input_channels": tensors["prompt_encoder.mask_embed.conv3.weight"].shape[1],
        },
        "mask_decoder_config": {
            "hidden_size": channels,
            "mlp_dim": tensors[decoder + "transformer.layers.0.mlp.lin1.weight"].shape[0],
            "num_hidden_layers": _count(tensors, decoder + r"transformer\.layers\.(\d+)\."),
            "num_multimask_outputs": len(tensors[decoder + "mask_tokens.weight"]) - 1,
            "iou_head_depth": 2 + _count(tensors, re.escape(head) + r"layers\.(\d+)\."),
            "iou_head_hidden_dim": tensors[head + "proj_in.weight"].shape[0],
        },
    }


def _count(tensors: Mapping[str, Tensor], pattern: str) -> int:
    numbers = [int(match[1]) for match in (re.match(pattern, name) for name in tensors) if match]
    return max(numbers, default=-1) + 1
