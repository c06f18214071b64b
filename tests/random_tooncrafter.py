"""Random weights of the interpolation, small or of full size, on disk in every format of the real ones."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path

import torch
from physanimator.rendering.networks.checkpoints import build_without_storage
from physanimator.rendering.networks.image_encoder import ImageEncoder, ImageEncoderConfiguration
from physanimator.rendering.tooncrafter import (
    AutoencoderConfiguration,
    ResamplerConfiguration,
    SketchEncoderConfiguration,
    UNetConfiguration,
)
from physanimator.rendering.tooncrafter.autoencoder import DualReferenceAutoencoder
from physanimator.rendering.tooncrafter.model_sizes import ModelSizes, sizes_file
from physanimator.rendering.tooncrafter.resampler import ImageResampler
from physanimator.rendering.tooncrafter.sketch_encoder import SketchEncoder
from physanimator.rendering.tooncrafter.text_encoder import TextEncoder, TextEncoderConfiguration
from physanimator.rendering.tooncrafter.unet import InterpolationUNet
from random_svd import open_clip, random_weights
from safetensors.torch import save_file
from torch import Tensor, nn

TINY = ModelSizes(
    UNetConfiguration(
        model_channels=32,
        num_res_blocks=1,
        num_head_channels=16,
        context_dim=16,
        init_attn_heads=2,
        image_tokens_per_frame=2,
    ),
    ResamplerConfiguration(
        dim=16, depth=1, heads=2, dim_head=8, num_queries=2, embedding_dim=32, output_dim=16, ff_mult=2
    ),
    AutoencoderConfiguration(ch=32, ch_mult=(1, 1, 1, 1), num_res_blocks=1, fusion_heads=2, fusion_dim_head=8),
    SketchEncoderConfiguration(model_channels=32, num_res_blocks=1, num_head_channels=16, context_dim=16),
    ImageEncoderConfiguration(width=32, layers=2, heads=2, hidden=48, patch=14, picture=28, projection=24),
    TextEncoderConfiguration(width=16, layers=2, heads=2),
)

Tensors = dict[str, Tensor]


def weights(sizes: ModelSizes = TINY, *, dtype: torch.dtype = torch.float32) -> dict[str, Tensors]:
    """Of every network, by our own names."""
    networks: dict[str, Callable[[], nn.Module]] = {
        "unet": lambda: InterpolationUNet(sizes.unet),
        "resampler": lambda: ImageResampler(sizes.resampler),
        "autoencoder": lambda: DualReferenceAutoencoder(sizes.autoencoder),
        "sketch": lambda: SketchEncoder(sizes.sketch),
        "image_encoder": lambda: ImageEncoder(sizes.image_encoder),
        "text_encoder": lambda: TextEncoder(sizes.text_encoder),
    }
    return {
        name: random_weights(build_without_storage(build), number, dtype=dtype)
        for number, (name, build) in enumerate(networks.items())
    }


def content(given: dict[str, Tensors], *, encoders: bool) -> Tensors:
    """The public file's tensors by their names; the pruned file has no encoders of text and pictures."""
    found = {InterpolationUNet.prefix + name: each for name, each in given["unet"].items()}
    found |= {ImageResampler.prefix + name: each for name, each in given["resampler"].items()}
    found |= {DualReferenceAutoencoder.prefix + name: each for name, each in given["autoencoder"].items()}
    if encoders:
        found |= {"embedder.model.visual." + name: each for name, each in open_clip(given["image_encoder"])}
        found |= {"cond_stage_model.model." + name: each for name, each in given["text_encoder"].items()}
        last = "cond_stage_model.model.transformer.resblocks."
        layers = {name.split(".")[2] for name in given["text_encoder"] if name.startswith("transformer.resblocks.")}
        found |= {
            f"{last}{len(layers)}.{name.split('.', 3)[3]}": torch.zeros_like(each)
            for name, each in given["text_encoder"].items()
            if name.startswith("transformer.resblocks.0.")
        }
        found |= {"cond_stage_model.model.logit_scale": torch.zeros(()), "embedder.mean": torch.zeros(3)}
        found |= {"betas": torch.zeros(1000), "scale_arr": torch.ones(1000)}
    return found


def write_sizes(weights: Path, sizes: ModelSizes = TINY) -> Path:
    """The document beside a file that tells the sizes of its networks."""
    file = sizes_file(weights)
    file.write_text(json.dumps(asdict(sizes)), encoding="utf-8")
    return file


def write_lightning(path: Path, given: dict[str, Tensors]) -> Path:
    """As the public ``model.ckpt``."""
    torch.save({"epoch": 7, "state_dict": content(given, encoders=True)}, path)
    return path


def write_deepspeed(path: Path, given: dict[str, Tensors]) -> Path:
    """As DeepSpeed writes it."""
    named = {"_forward_module." + name: each for name, each in content(given, encoders=True).items()}
    torch.save({"module": named, "global_steps": 3}, path)
    return path


def write_pruned(path: Path, given: dict[str, Tensors], *, dtype: torch.dtype = torch.float16) -> Path:
    """As the pruned safetensors file."""
    named = content(given, encoders=False)
    save_file({name: each.to(dtype).contiguous() for name, each in named.items()}, path)
    return path


def write_sketch_encoder(path: Path, given: dict[str, Tensors], *, wrapped: bool = False) -> Path:
    """As ``sketch_encoder.ckpt``, plain or as a training checkpoint, or as safetensors."""
    if path.suffix == ".safetensors":
        save_file(given["sketch"], path)
    else:
        torch.save({"state_dict": given["sketch"]} if wrapped else given["sketch"], path)
    return path


def write_image_encoder(path: Path, given: dict[str, Tensors], *, by_open_clip: bool = False) -> Path:
    """A picture encoder in a file of its own, by the names of transformers or of OpenCLIP."""
    named = given["image_encoder"]
    if by_open_clip:
        named = {"visual." + name: each.contiguous() for name, each in open_clip(named)}
    save_file({**named, "logit_scale": torch.zeros(())}, path)
    return path


def write_text_encoder(path: Path, given: dict[str, Tensors]) -> Path:
    """A text encoder in a file of its own, by the names of transformers."""
    named = dict(_transformers(given["text_encoder"]))
    save_file({"text_model." + name: each.contiguous() for name, each in named.items()}, path)
    return path


def _transformers(tensors: Tensors) -> Iterator[tuple[str, Tensor]]:
    ends = {"token_embedding.weight": "embeddings.token_embedding.weight"}
    ends |= {"positional_embedding": "embeddings.position_embedding.weight"}
    parts = {"ln_1": "layer_norm1", "ln_2": "layer_norm2", "attn.out_proj": "self_attn.out_proj"}
    parts |= {"mlp.c_fc": "mlp.fc1", "mlp.c_proj": "mlp.fc2"}
    for name, tensor in tensors.items():
        layer = re.match(r"transformer\.resblocks\.(\d+)\.(.*)", name)
        if layer is None:
            yield ends.get(name, name.replace("ln_final", "final_layer_norm")), tensor
        elif "in_proj_" in name:
            for letter, third in zip("qkv", tensor.chunk(3), strict=True):
                yield f"encoder.layers.{layer[1]}.self_attn.{letter}_proj.{name.rsplit('_', 1)[1]}", third
        else:
            part, end = layer[2].rsplit(".", 1)
            yield f"encoder.layers.{layer[1]}.{parts[part]}.{end}", tensor
