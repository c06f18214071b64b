"""Stands in for the node pack ComfyUI-WanVideoWrapper in the test host: nodes with inputs and outputs, no models.

As in its sources of late 2025. Optional inputs that no workflow of ours connects are left out where they are links.
"""

from __future__ import annotations

from typing import Any

import folder_paths

_ON, _OFF = ("BOOLEAN", {"default": True}), ("BOOLEAN", {"default": False})
_SCHEDULERS = ["unipc", "unipc/beta", "dpm++", "dpm++/beta", "dpm++_sde", "dpm++_sde/beta", "euler", "euler/beta"]
_SCALED = [f"fp8_{kind}{end}" for kind in ("e4m3fn", "e5m2") for end in ("", "_fast", "_scaled", "_scaled_fast")]
_ATTENTION = ["sdpa", "flash_attn_2", "flash_attn_3", "sageattn", "sageattn_3", "radial_sage_attention", "comfy"]


def _whole(default: int, least: int, most: int, step: int = 1) -> tuple[str, dict[str, int]]:
    return "INT", {"default": default, "min": least, "max": most, "step": step}


def _number(default: float, most: float, step: float) -> tuple[str, dict[str, float]]:
    return "FLOAT", {"default": default, "min": 0.0, "max": most, "step": step}


_TILES = {"tile_x": _whole(272, 64, 2048), "tile_y": _whole(272, 64, 2048),
          "tile_stride_x": _whole(144, 32, 2048, 32), "tile_stride_y": _whole(128, 32, 2048, 32)}  # fmt: skip


def _files(folder: str) -> tuple[list[str]]:
    return (folder_paths.get_filename_list(folder),)


def _node(inputs: Any, outputs: dict[str, str]) -> type:
    class Node:
        @classmethod
        def INPUT_TYPES(cls) -> dict[str, Any]:
            return inputs()

        RETURN_TYPES = tuple(outputs.values())
        RETURN_NAMES = tuple(outputs)
        FUNCTION = "run"
        CATEGORY = "WanVideoWrapper"

        def run(self, **inputs: Any) -> tuple[Any, ...]:
            raise RuntimeError("this node is a stand-in without models")

    return Node


def _model_loader() -> dict[str, Any]:
    return {
        "required": {
            "model": _files("diffusion_models"),
            "base_precision": (["fp32", "bf16", "fp16", "fp16_fast"], {"default": "bf16"}),
            "quantization": (["disabled", *_SCALED], {"default": "disabled"}),
            "load_device": (["main_device", "offload_device"], {"default": "offload_device"}),
        },
        "optional": {
            "attention_mode": (_ATTENTION, {"default": "sdpa"}),
            "block_swap_args": ("BLOCKSWAPARGS",),
            "rms_norm_function": (["default", "pytorch"], {"default": "default"}),
        },
    }


def _vae_loader() -> dict[str, Any]:
    optional = {"precision": (["fp16", "fp32", "bf16"], {"default": "bf16"}), "use_cpu_cache": _OFF, "verbose": _OFF}
    return {"required": {"model_name": _files("vae")}, "optional": optional}


def _encoder_loader() -> dict[str, Any]:
    return {
        "required": {
            "model_name": _files("text_encoders"),
            "precision": (["fp32", "bf16"], {"default": "bf16"}),
        },
        "optional": {
            "load_device": (["main_device", "offload_device"], {"default": "offload_device"}),
            "quantization": (["disabled", "fp8_e4m3fn"], {"default": "disabled"}),
        },
    }


def _text_encode() -> dict[str, Any]:
    text = ("STRING", {"default": "", "multiline": True})
    return {
        "required": {"positive_prompt": text, "negative_prompt": text},
        "optional": {
            "t5": ("WANTEXTENCODER",),
            "force_offload": _ON,
            "model_to_offload": ("WANVIDEOMODEL",),
            "use_disk_cache": _OFF,
            "device": (["gpu", "cpu"], {"default": "gpu"}),
        },
    }


def _image_encode() -> dict[str, Any]:
    return {
        "required": {
            "width": _whole(832, 64, 8096, 8),
            "height": _whole(480, 64, 8096, 8),
            "num_frames": _whole(81, 1, 10_000, 4),
            "noise_aug_strength": _number(0.0, 10.0, 0.001),
            "start_latent_strength": _number(1.0, 10.0, 0.001),
            "end_latent_strength": _number(1.0, 10.0, 0.001),
            "force_offload": _ON,
        },
        "optional": {
            "vae": ("WANVAE",),
            "start_image": ("IMAGE",),
            "end_image": ("IMAGE",),
            "fun_or_fl2v_model": _ON,
            "tiled_vae": _OFF,
            "augment_empty_frames": _number(0.0, 10.0, 0.01),
        },
    }


def _encode() -> dict[str, Any]:
    return {
        "required": {"vae": ("WANVAE",), "image": ("IMAGE",), "enable_vae_tiling": _OFF, **_TILES},
        "optional": {
            "noise_aug_strength": _number(0.0, 10.0, 0.001),
            "latent_strength": _number(1.0, 10.0, 0.001),
            "mask": ("MASK",),
        },
    }


def _time_to_move() -> dict[str, Any]:
    return {
        "required": {
            "embeds": ("WANVIDIMAGE_EMBEDS",),
            "reference_latents": ("LATENT",),
            "mask": ("MASK",),
            "start_step": _whole(0, -1, 1000),
            "end_step": _whole(1, 1, 1000),
        }
    }


def _sampler() -> dict[str, Any]:
    return {
        "required": {
            "model": ("WANVIDEOMODEL",),
            "image_embeds": ("WANVIDIMAGE_EMBEDS",),
            "steps": ("INT", {"default": 30, "min": 1}),
            "cfg": _number(6.0, 30.0, 0.01),
            "shift": _number(5.0, 1000.0, 0.01),
            "seed": _whole(0, 0, 2**64 - 1),
            "force_offload": _ON,
            "scheduler": (_SCHEDULERS, {"default": "unipc"}),
            "riflex_freq_index": _whole(0, 0, 1000),
        },
        "optional": {
            "text_embeds": ("WANVIDEOTEXTEMBEDS",),
            "samples": ("LATENT",),
            "denoise_strength": _number(1.0, 1.0, 0.01),
            "batched_cfg": _OFF,
            "rope_function": (["default", "comfy", "comfy_chunked"], {"default": "comfy"}),
            "start_step": _whole(0, 0, 10_000),
            "end_step": _whole(-1, -1, 10_000),
            "add_noise_to_samples": _OFF,
        },
    }


def _decode() -> dict[str, Any]:
    tiles = {name: ("INT", {**options, "min": 40 if "stride" not in name else 32, "step": 8})
             for name, (_, options) in _TILES.items()}  # fmt: skip
    return {
        "required": {"vae": ("WANVAE",), "samples": ("LATENT",), "enable_vae_tiling": _OFF, **tiles},
        "optional": {"normalization": (["default", "minmax", "none"], {"advanced": True})},
    }


NODE_CLASS_MAPPINGS = {
    "WanVideoModelLoader": _node(_model_loader, {"model": "WANVIDEOMODEL"}),
    "WanVideoVAELoader": _node(_vae_loader, {"vae": "WANVAE"}),
    "LoadWanVideoT5TextEncoder": _node(_encoder_loader, {"wan_t5_model": "WANTEXTENCODER"}),
    "WanVideoTextEncode": _node(_text_encode, {"text_embeds": "WANVIDEOTEXTEMBEDS"}),
    "WanVideoImageToVideoEncode": _node(_image_encode, {"image_embeds": "WANVIDIMAGE_EMBEDS"}),
    "WanVideoEncode": _node(_encode, {"samples": "LATENT"}),
    "WanVideoAddTTMLatents": _node(_time_to_move, {"image_embeds": "WANVIDIMAGE_EMBEDS"}),
    "WanVideoSampler": _node(_sampler, {"samples": "LATENT", "denoised_samples": "LATENT"}),
    "WanVideoDecode": _node(_decode, {"images": "IMAGE"}),
}
