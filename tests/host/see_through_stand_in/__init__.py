"""Stands in for the node pack ComfyUI-See-through in the test host: its nodes' names, inputs and outputs, no models.

As in version 0.4.4. What comes out are the layers of the bundled example, in the pack's own form.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

_SIDE = {"min": 512, "max": 2048, "step": 64}
_SEED = ("INT", {"default": 42, "min": 0, "max": 2**32 - 1})
_ON, _OFF = ("BOOLEAN", {"default": True}), ("BOOLEAN", {"default": False})
_MEMORY = {"quant_mode": (["none", "nf4"], {"default": "none"}), "cache_tag_embeds": _ON, "group_offload": _OFF,
           "auto_download": _ON}  # fmt: skip


def _node(required: dict[str, Any], optional: dict[str, Any], outputs: dict[str, str]) -> type:
    class Node:
        @classmethod
        def INPUT_TYPES(cls) -> dict[str, Any]:
            return {"required": required, "optional": optional}

        RETURN_TYPES = tuple(outputs.values())
        RETURN_NAMES = tuple(outputs)
        FUNCTION = "run"
        CATEGORY = "SeeThrough"

        def run(self, **inputs: Any) -> tuple[Any, ...]:
            kept = inputs.get("image", next(iter(inputs.values())))
            return tuple(_example_parts() if kind == "SEETHROUGH_PARTS" else kept for kind in outputs.values())

    return Node


def _example_parts() -> dict[str, Any]:
    import numpy as np
    from psd_tools import PSDImage

    # The pack lies in custom_nodes, beside a link to this checkout.
    example = Path(__file__).resolve().parents[3] / "workflows" / "example" / "illustration.psd"
    drawn = PSDImage.open(example)
    parts = {
        layer.name: {"img": np.asarray(layer.topil().convert("RGBA")), "xyxy": list(layer.bbox),
                     "depth_median": 1 - number / 100, "tag": layer.name}
        for number, layer in enumerate(drawn)
    }  # fmt: skip
    return {"frame_size": (drawn.height, drawn.width), "tag2pinfo": parts}


NODE_CLASS_MAPPINGS = {
    "SeeThrough_LoadLayerDiffModel": _node(
        {"model": (["layerdifforg/seethroughv0.0.2_layerdiff3d", "24yearsold/seethroughv0.0.2_layerdiff3d_nf4"],)},
        {"vae_ckpt": ("STRING", {"default": ""}), "unet_ckpt": ("STRING", {"default": ""}), **_MEMORY},
        {"layerdiff_model": "SEETHROUGH_LAYERDIFF_MODEL"},
    ),
    "SeeThrough_LoadDepthModel": _node(
        {"model": (["layerdifforg/seethroughv0.0.1_marigold", "24yearsold/seethroughv0.0.1_marigold_nf4"],)},
        _MEMORY,
        {"depth_model": "SEETHROUGH_DEPTH_MODEL"},
    ),
    "SeeThrough_GenerateLayers": _node(
        {
            "image": ("IMAGE",),
            "layerdiff_model": ("SEETHROUGH_LAYERDIFF_MODEL",),
            "seed": _SEED,
            "resolution": ("INT", {"default": 1280, **_SIDE}),
            "num_inference_steps": ("INT", {"default": 30, "min": 1, "max": 100}),
        },
        {},
        {"layers": "SEETHROUGH_LAYERS", "preview": "IMAGE"},
    ),
    "SeeThrough_GenerateDepth": _node(
        {"layers": ("SEETHROUGH_LAYERS",), "depth_model": ("SEETHROUGH_DEPTH_MODEL",), "seed": _SEED},
        {"resolution_depth": ("INT", {"default": -1, "min": -1, "max": 2048, "step": 64})},
        {"layers_depth": "SEETHROUGH_LAYERS_DEPTH", "preview": "IMAGE"},
    ),
    "SeeThrough_PostProcess": _node(
        {"layers_depth": ("SEETHROUGH_LAYERS_DEPTH",), "tblr_split": _ON, "use_lama": _ON},
        {},
        {"parts": "SEETHROUGH_PARTS", "preview": "IMAGE"},
    ),
}
