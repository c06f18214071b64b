"""Random weights of the sketch-guided renderer, small or of full size, on disk in every format of the real ones."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import torch
from physanimator.rendering.networks.checkpoints import build_without_storage
from physanimator.rendering.networks.image_encoder import ImageEncoder, ImageEncoderConfiguration
from physanimator.rendering.svd import NetworkConfiguration
from physanimator.rendering.svd.autoencoder import build_autoencoder
from physanimator.rendering.svd.controlnet import SketchControlNet
from physanimator.rendering.svd.svd_weights import ModelSizes
from physanimator.rendering.svd.unet import SpatioTemporalUNet
from safetensors.torch import save_file
from torch import Tensor, nn

TINY = ModelSizes(
    NetworkConfiguration(model_channels=32, num_head_channels=16, context_dim=24, adm_in_channels=24, ids_embed_dim=8),
    (32, 32, 32, 32),
    ImageEncoderConfiguration(width=32, layers=2, heads=2, hidden=48, patch=14, picture=28, projection=24),
)

Tensors = dict[str, Tensor]

_DISTINCT = 2**20


def random_weights(network: nn.Module, seed: int, *, dtype: torch.dtype = torch.float32) -> Tensors:
    """Weights for a network, also for one without storage.

    Normalisations stay near 1, all else is small enough for numbers to stay moderate. Large tensors repeat themselves.
    """
    generator = torch.Generator().manual_seed(seed)
    found = {}
    for name, tensor in network.state_dict().items():
        count = tensor.numel()
        noise = torch.randn(min(count, _DISTINCT), generator=generator)
        fan_in = max(tensor[0].numel(), 1) if tensor.ndim > 1 else 25
        gain = 1.0 if tensor.ndim == 1 and name.endswith("weight") else 0.0
        values = (gain + noise * fan_in**-0.5).to(dtype)
        found[name] = values.repeat(-(-count // _DISTINCT))[:count].reshape(tensor.shape)
    return found


def weights(sizes: ModelSizes = TINY, *, dtype: torch.dtype = torch.float32) -> dict[str, Tensors]:
    """Of every network, by our own names, and the attention that LVCD has instead."""
    unet = build_without_storage(lambda: SpatioTemporalUNet(sizes.network))
    control = build_without_storage(lambda: SketchControlNet(sizes.network))
    autoencoder = build_without_storage(lambda: build_autoencoder(sizes.autoencoder))
    encoder = build_without_storage(lambda: ImageEncoder(sizes.image_encoder))
    attention = _Attention({name: each for name, each in unet.state_dict().items() if ".attn1." in name})
    return {
        "unet": random_weights(unet, 1, dtype=dtype),
        "control": random_weights(control, 2, dtype=dtype),
        "autoencoder": random_weights(autoencoder, 3, dtype=dtype),
        "image_encoder": random_weights(encoder, 4, dtype=dtype),
        "attention": random_weights(attention, 5, dtype=dtype),
    }


class _Attention(nn.Module):
    """Stands for the part of the UNet that LVCD's file holds."""

    def __init__(self, tensors: Tensors) -> None:
        super().__init__()
        self.tensors = tensors

    def state_dict(self, *_: Any, **__: Any) -> Any:
        return self.tensors


def write_single_file(path: Path, given: dict[str, Tensors]) -> Path:
    """As the public ``svd.safetensors``: UNet, autoencoder, the condition's encoder, picture encoder."""
    autoencoder = dict(_public_autoencoder(given["autoencoder"]))
    content = {SpatioTemporalUNet.prefix + name: tensor for name, tensor in given["unet"].items()}
    for name, tensor in autoencoder.items():
        if name.startswith("decoder."):
            content["first_stage_model." + name] = tensor
        else:
            content["conditioner.embedders.3.encoder." + name] = tensor
        if name.startswith("encoder."):
            content["first_stage_model." + name] = torch.zeros_like(tensor)
    for name, tensor in open_clip(given["image_encoder"]):
        content["conditioner.embedders.0.open_clip.model.visual." + name] = tensor
    content["conditioner.embedders.0.open_clip.model.logit_scale"] = torch.zeros(())
    save_file({name: tensor.contiguous() for name, tensor in content.items()}, path)
    return path


def write_folder(
    path: Path, given: dict[str, Tensors], *, suffix: str = ".safetensors", sizes: ModelSizes = TINY
) -> Path:
    """As diffusers' version."""
    network, encoder = sizes.network, sizes.image_encoder
    configs = {
        "unet": {
            "in_channels": network.in_channels,
            "out_channels": network.out_channels,
            "block_out_channels": network.level_channels,
            "down_block_types": ["CrossAttnDownBlockSpatioTemporal"] * 3 + ["DownBlockSpatioTemporal"],
            "layers_per_block": network.num_res_blocks,
            "num_attention_heads": [each // network.num_head_channels for each in network.level_channels],
            "cross_attention_dim": network.context_dim,
            "projection_class_embeddings_input_dim": network.adm_in_channels,
            "addition_time_embed_dim": network.ids_embed_dim,
        },
        "vae": {"block_out_channels": sizes.autoencoder},
        "image_encoder": {
            "hidden_size": encoder.width,
            "num_hidden_layers": encoder.layers,
            "num_attention_heads": encoder.heads,
            "intermediate_size": encoder.hidden,
            "patch_size": encoder.patch,
            "image_size": encoder.picture,
            "projection_dim": encoder.projection,
        },
    }
    places = torch.arange(5)[None]
    tensors = {
        "unet": dict(diffusers_unet(given["unet"])),
        "vae": given["autoencoder"],
        "image_encoder": {**given["image_encoder"], "vision_model.embeddings.position_ids": places},
    }
    for part, config in configs.items():
        (path / part).mkdir(parents=True)
        (path / part / "config.json").write_text(json.dumps(config))
        stem = "diffusion_pytorch_model"
        if part == "image_encoder":
            stem = "pytorch_model" if suffix == ".bin" else "model"
        file = path / part / f"{stem}{suffix}"
        torch.save(tensors[part], file) if suffix == ".bin" else save_file(tensors[part], file)
    return path


def write_lvcd(path: Path, given: dict[str, Tensors], *, dtype: torch.dtype = torch.float32) -> Path:
    """As ``lvcd.ckpt`` (a training checkpoint) or ``lvcd-fp16.safetensors``."""
    content = {SketchControlNet.prefix + name: tensor.to(dtype) for name, tensor in given["control"].items()}
    content |= {SpatioTemporalUNet.prefix + name: tensor.to(dtype) for name, tensor in given["attention"].items()}
    if path.suffix == ".safetensors":
        save_file(content, path)
    else:
        torch.save({"epoch": 7, "state_dict": content, "optimizer_states": [{"lr": 1e-5}]}, path)
    return path


def diffusers_unet(tensors: Tensors) -> Iterator[tuple[str, Tensor]]:
    """Diffusers' names, read off the order of the blocks of both; small and full size have the same."""
    levels, blocks = len(TINY.network.channel_mult), TINY.network.num_res_blocks
    places = {"middle_block.0.": "mid_block.resnets.0.", "middle_block.1.": "mid_block.attentions.0."}
    places |= {"middle_block.2.": "mid_block.resnets.1.", "input_blocks.0.0.": "conv_in."}
    places |= {"time_embed.0.": "time_embedding.linear_1.", "time_embed.2.": "time_embedding.linear_2."}
    places |= {"label_emb.0.0.": "add_embedding.linear_1.", "label_emb.0.2.": "add_embedding.linear_2."}
    places |= {"out.0.": "conv_norm_out.", "out.2.": "conv_out."}
    stage = 1
    for level in range(levels):
        for block in range(blocks):
            places[f"input_blocks.{stage}.0."] = f"down_blocks.{level}.resnets.{block}."
            places[f"input_blocks.{stage}.1."] = f"down_blocks.{level}.attentions.{block}."
            stage += 1
        places[f"input_blocks.{stage}.0.op."] = f"down_blocks.{level}.downsamplers.0.conv."
        stage += 1
    for stage in range(levels * (blocks + 1)):
        up, block = divmod(stage, blocks + 1)
        places[f"output_blocks.{stage}.0."] = f"up_blocks.{up}.resnets.{block}."
        places[f"output_blocks.{stage}.1."] = f"up_blocks.{up}.attentions.{block}."
        for place in (1, 2):
            places[f"output_blocks.{stage}.{place}.conv."] = f"up_blocks.{up}.upsamplers.0.conv."
    layers = {"in_layers.0.": "norm1.", "in_layers.2.": "conv1.", "emb_layers.1.": "time_emb_proj."}
    layers |= {"out_layers.0.": "norm2.", "out_layers.3.": "conv2.", "skip_connection.": "conv_shortcut."}
    for name, tensor in tensors.items():
        ours = max((each for each in places if name.startswith(each)), key=len)
        rest = name.removeprefix(ours)
        if ".resnets." in places[ours] and not rest.startswith("time_mixer."):
            block = "temporal_res_block." if rest.startswith("time_stack.") else "spatial_res_block."
            rest = rest.removeprefix("time_stack.")
            layer = next(each for each in layers if rest.startswith(each))
            rest = block + layers[layer] + rest.removeprefix(layer)
        elif ".attentions." in places[ours]:
            rest = rest.replace("time_stack.", "temporal_transformer_blocks.")
            rest = rest.replace("embed.0.", "embed.linear_1.").replace("embed.2.", "embed.linear_2.")
        yield places[ours] + rest, tensor


def _public_autoencoder(tensors: Tensors) -> Iterator[tuple[str, Tensor]]:
    """The single file's names, by the grammar of both."""
    last = len(TINY.autoencoder) - 1
    for name, tensor in tensors.items():
        public = name.replace("mid_block.attentions.0.", "mid.attn_1.")
        for theirs, ours in (("group_norm", "norm"), ("to_q", "q"), ("to_k", "k"), ("to_v", "v")):
            public = public.replace(f"attn_1.{theirs}.", f"attn_1.{ours}.")
        public = public.replace("attn_1.to_out.0.", "attn_1.proj_out.")
        matrix = "attn_1" in public and tensor.ndim == 2
        for block in (0, 1):
            public = public.replace(f"mid_block.resnets.{block}.", f"mid.block_{block + 1}.")
        for level in range(last + 1):
            public = public.replace(f"down_blocks.{level}.", f"down.{level}.")
            public = public.replace(f"up_blocks.{level}.", f"up.{last - level}.")
        public = public.replace("resnets.", "block.").replace("samplers.0.", "sample.")
        if "temporal_res_block." in public:
            public = public.replace("temporal_res_block.", "time_stack.")
            for theirs, ours in (
                ("norm1", "in_layers.0"),
                ("conv1", "in_layers.2"),
                ("norm2", "out_layers.0"),
                ("conv2", "out_layers.3"),
            ):
                public = public.replace(f"time_stack.{theirs}.", f"time_stack.{ours}.")
        public = public.replace("spatial_res_block.", "").replace("time_mixer.", "")
        public = public.replace("conv_shortcut.", "nin_shortcut.").replace("conv_norm_out.", "norm_out.")
        public = public.replace("time_conv_out.", "conv_out.time_mix_conv.")
        yield public, tensor[:, :, None, None] if matrix else tensor


def open_clip(tensors: Tensors) -> Iterator[tuple[str, Tensor]]:
    """OpenCLIP's names, in which queries, keys and values are one tensor."""
    named = {
        "vision_model.embeddings.class_embedding": "class_embedding",
        "vision_model.embeddings.position_embedding.weight": "positional_embedding",
        "vision_model.embeddings.patch_embedding.weight": "conv1.weight",
    }
    for name, tensor in tensors.items():
        if name == "visual_projection.weight":
            yield "proj", tensor.T
        elif ".q_proj." in name:
            parts = [tensors[name.replace(".q_proj.", f".{letter}_proj.")] for letter in "qkv"]
            layer, kind = name.split(".")[3], name.rsplit(".", 1)[1]
            yield f"transformer.resblocks.{layer}.attn.in_proj_{kind}", torch.cat(parts)
        elif ".k_proj." not in name and ".v_proj." not in name:
            public = named.get(name, name)
            for ours, theirs in (
                ("vision_model.encoder.layers.", "transformer.resblocks."),
                ("self_attn.", "attn."),
                ("layer_norm", "ln_"),
                ("fc1", "c_fc"),
                ("fc2", "c_proj"),
                ("vision_model.pre_layrnorm", "ln_pre"),
                ("vision_model.post_layernorm", "ln_post"),
            ):
                public = public.replace(ours, theirs)
            yield public, tensor
