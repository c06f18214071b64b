"""Random Segment Anything networks, small, on disk as the real ones are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import torch
import transformers

SIDE, PATCH = 64, 8

_PROMPTS = {"hidden_size": 16, "image_size": SIDE, "patch_size": PATCH, "mask_input_channels": 4}
_DECODER = {"hidden_size": 16, "mlp_dim": 24, "num_attention_heads": 2, "iou_head_hidden_dim": 16}
_VISION = {
    "hidden_size": 32,
    "num_hidden_layers": 2,
    "num_attention_heads": 2,
    "mlp_dim": 48,
    "image_size": SIDE,
    "patch_size": PATCH,
    "window_size": 3,
    "global_attn_indexes": [1],
    "output_channels": 16,
    "num_pos_feats": 8,
}
_HIERA = {
    "model_type": "sam2_hiera_det_model",
    "hidden_size": 8,
    "image_size": [SIDE, SIDE],
    "blocks_per_stage": [1, 1, 2, 1],
    "embed_dim_per_stage": [8, 16, 32, 64],
    "num_attention_heads_per_stage": [1, 1, 2, 2],
    "window_size_per_stage": [4, 4, 4, 4],
    "window_positional_embedding_background_size": [4, 4],
    "global_attention_blocks": [3],
}
_PYRAMID = {
    "backbone_channel_list": [64, 32, 16, 8],
    "backbone_feature_sizes": [[16, 16], [8, 8], [4, 4]],
    "fpn_hidden_size": 16,
}
_VIT = {
    "model_type": "sam3_vit_model",
    "hidden_size": 32,
    "intermediate_size": 48,
    "num_hidden_layers": 2,
    "num_attention_heads": 2,
    "image_size": SIDE,
    "patch_size": PATCH,
    "pretrain_image_size": SIDE,
    "window_size": 4,
    "global_attn_indexes": [1],
}


def random_network(name: str, *, seed: int = 0) -> Any:
    """A small network whose every weight counts.

    Args:
        name: a ``model_type``: sam, sam_hq, sam2 or sam3_tracker.
        seed: of the weights.
    """
    torch.manual_seed(seed)
    network = _built(name).eval()
    with torch.no_grad():
        for parameter in network.parameters():
            parameter.normal_(0, 0.3)
    return network


def save_network(network: Any, folder: Path) -> Path:
    """config.json and model.safetensors in a folder."""
    network.save_pretrained(folder)
    return folder


def _built(name: str) -> Any:
    both = {"prompt_encoder_config": _PROMPTS, "mask_decoder_config": _DECODER}
    if name == "sam":
        return transformers.SamModel(transformers.SamConfig(vision_config=_VISION, **both))
    if name == "sam_hq":
        decoder = _DECODER | {"vit_dim": _VISION["hidden_size"]}
        return transformers.SamHQModel(
            transformers.SamHQConfig(vision_config=_VISION, **(both | {"mask_decoder_config": decoder}))
        )
    if name == "sam2":
        vision = {"backbone_config": _HIERA, **_PYRAMID}
        return transformers.Sam2Model(transformers.Sam2Config(vision_config=vision, **_sixteenth(both)))
    vision = {"backbone_config": _VIT, "fpn_hidden_size": 16, "backbone_feature_sizes": [[32, 32], [16, 16], [8, 8]]}
    return transformers.Sam3TrackerModel(transformers.Sam3TrackerConfig(vision_config=vision, **both))


def _sixteenth(configs: dict[str, Any]) -> dict[str, Any]:
    """For networks whose coarsest features have a sixteenth of the square's side."""
    return configs | {"prompt_encoder_config": _PROMPTS | {"patch_size": 16}}
