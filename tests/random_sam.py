"""Random Segment Anything networks, small, on disk as the real ones are."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import torch
import transformers

SIDE, PATCH = 64, 8

_PROMPTS = {"hidden_size": 16, "image_size": SIDE, "patch_size": PATCH, "mask_input_channels": 4}
_DECODER = {"hidden_size": 16, "mlp_dim": 24, "num_attention_heads": 8, "iou_head_hidden_dim": 16}
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


def original_names(tensors: dict[str, Any]) -> dict[str, Any]:
    """SAM's weights as its authors name them, with the extra entries of their files left out.

    Args:
        tensors: of a network that ``random_network("sam")`` made, by the names of transformers.
    """
    renamed = {}
    for name, tensor in tensors.items():
        if name != "prompt_encoder.shared_embedding.positional_embedding":
            for new, old in _ORIGINAL:
                name = re.sub(new, old, name)
            renamed[name] = tensor
    return renamed


_ORIGINAL = (
    (r"^shared_image_embedding\.positional_embedding$", "prompt_encoder.pe_layer.positional_encoding_gaussian_matrix"),
    (r"^vision_encoder\.neck\.conv1", "image_encoder.neck.0"),
    (r"^vision_encoder\.neck\.layer_norm1", "image_encoder.neck.1"),
    (r"^vision_encoder\.neck\.conv2", "image_encoder.neck.2"),
    (r"^vision_encoder\.neck\.layer_norm2", "image_encoder.neck.3"),
    (r"^vision_encoder\.patch_embed\.projection", "image_encoder.patch_embed.proj"),
    (r"^vision_encoder\.layers", "image_encoder.blocks"),
    (r"^vision_encoder", "image_encoder"),
    (r"\.layer_norm(\d|_final_attn)", r".norm\1"),
    (r"\.point_embed\.", ".point_embeddings."),
    (r"\.mask_embed\.conv1", ".mask_downscaling.0"),
    (r"\.mask_embed\.norm1", ".mask_downscaling.1"),
    (r"\.mask_embed\.conv2", ".mask_downscaling.3"),
    (r"\.mask_embed\.norm2", ".mask_downscaling.4"),
    (r"\.mask_embed\.conv3", ".mask_downscaling.6"),
    (r"\.upscale_conv1", ".output_upscaling.0"),
    (r"\.upscale_layer_norm", ".output_upscaling.1"),
    (r"\.upscale_conv2", ".output_upscaling.3"),
    (r"(mlps\.\d|prediction_head)\.layers\.0\.", r"\1.layers.1."),
    (r"(mlps\.\d|prediction_head)\.proj_in\.", r"\1.layers.0."),
    (r"(mlps\.\d|prediction_head)\.proj_out\.", r"\1.layers.2."),
)
