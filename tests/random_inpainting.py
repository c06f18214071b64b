"""Stable Diffusion with small random networks, as a diffusers folder on disk."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import torch
from diffusers import AutoencoderKL, DDIMScheduler, UNet2DConditionModel

__all__ = ["write_inpainting_folder"]

_WORDS = ["<|startoftext|>", "<|endoftext|>", "g", "i", "r", "l</w>", "r</w>", "l", "s</w>"]
_LEVELS = (32, 64)


def write_inpainting_folder(path: Path, *, sees_holes: bool = False, seed: int = 0, **unet: Any) -> Path:
    """Write one.

    Args:
        path: of the folder.
        sees_holes: with a UNet for inpainting.
        seed: of the weights.
        unet: other sizes of the UNet.
    """
    from transformers import CLIPTextConfig, CLIPTextModel

    torch.manual_seed(seed)
    sizes: dict[str, Any] = {
        "sample_size": 16,
        "in_channels": 9 if sees_holes else 4,
        "block_out_channels": _LEVELS,
        "down_block_types": ("CrossAttnDownBlock2D", "DownBlock2D"),
        "up_block_types": ("UpBlock2D", "CrossAttnUpBlock2D"),
        "layers_per_block": 1,
        "attention_head_dim": 4,
        "cross_attention_dim": 32,
        "norm_num_groups": 8,
    }
    UNet2DConditionModel(**(sizes | unet)).save_pretrained(path / "unet")
    AutoencoderKL(
        block_out_channels=(8, 16, 16, 16),
        down_block_types=("DownEncoderBlock2D",) * 4,
        up_block_types=("UpDecoderBlock2D",) * 4,
        norm_num_groups=8,
        latent_channels=4,
    ).save_pretrained(path / "vae")
    text = CLIPTextConfig(
        vocab_size=len(_WORDS),
        hidden_size=32,
        intermediate_size=48,
        num_hidden_layers=2,
        num_attention_heads=2,
        max_position_embeddings=20,
        bos_token_id=0,
        eos_token_id=1,
        pad_token_id=1,
    )
    CLIPTextModel(text).save_pretrained(path / "text_encoder")
    # As Stable Diffusion 1 has it.
    schedule = {"beta_start": 0.00085, "beta_end": 0.012, "beta_schedule": "scaled_linear", "steps_offset": 1}
    DDIMScheduler(clip_sample=False, set_alpha_to_one=False, **schedule).save_pretrained(path / "scheduler")
    tokenizer = path / "tokenizer"
    tokenizer.mkdir()
    (tokenizer / "vocab.json").write_text(json.dumps({word: number for number, word in enumerate(_WORDS)}))
    (tokenizer / "merges.txt").write_text("#version: 0.2\n")
    kept = {"tokenizer_class": "CLIPTokenizer", "model_max_length": 20}
    (tokenizer / "tokenizer_config.json").write_text(json.dumps(kept))
    return path
