"""From OpenCLIP's names, as in the single-file checkpoint, to those of our picture encoder."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from torch import Tensor

__all__ = ["from_open_clip"]

_NAMES = {
    "class_embedding": "vision_model.embeddings.class_embedding",
    "positional_embedding": "vision_model.embeddings.position_embedding.weight",
    "conv1.weight": "vision_model.embeddings.patch_embedding.weight",
}
_PARTS = {
    "ln_pre.": "vision_model.pre_layrnorm.",
    "ln_post.": "vision_model.post_layernorm.",
    "ln_1.": "layer_norm1.",
    "ln_2.": "layer_norm2.",
    "attn.out_proj.": "self_attn.out_proj.",
    "mlp.c_fc.": "mlp.fc1.",
    "mlp.c_proj.": "mlp.fc2.",
}


def from_open_clip(tensors: Mapping[str, Tensor]) -> dict[str, Tensor]:
    """The same weights by our names; queries, keys and values, one tensor there, become three views of it."""
    return dict(pair for name, tensor in tensors.items() for pair in _renamed(name, tensor))


def _renamed(name: str, tensor: Tensor) -> Iterator[tuple[str, Tensor]]:
    layer = re.match(r"transformer\.resblocks\.(\d+)\.(.*)", name)
    prefix, rest = (f"vision_model.encoder.layers.{layer[1]}.", layer[2]) if layer else ("", name)
    if name == "proj":
        yield "visual_projection.weight", tensor.T
    elif rest.startswith("attn.in_proj_"):
        for letter, third in zip("qkv", tensor.chunk(3), strict=True):
            yield f"{prefix}self_attn.{letter}_proj.{rest.removeprefix('attn.in_proj_')}", third
    else:
        part = next((each for each in _PARTS if rest.startswith(each)), "")
        yield _NAMES.get(name, prefix + _PARTS.get(part, part) + rest[len(part) :]), tensor
