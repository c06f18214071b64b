"""The prompt encoder: OpenCLIP's ViT-H text transformer, as Stable Diffusion 2.1 uses it (last layer left out)."""

from __future__ import annotations

import re
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass

import torch
from torch import Tensor, nn

__all__ = ["TextEncoder", "TextEncoderConfiguration", "empty_prompt", "text_weights"]

# Numbers of the tokens that begin a prompt, end it and fill it up, as OpenCLIP counts them.
_START, _END, _PADDING = 49406, 49407, 0

_FOREIGN_PARTS = {
    "layer_norm1.": "ln_1.",
    "layer_norm2.": "ln_2.",
    "self_attn.out_proj.": "attn.out_proj.",
    "mlp.fc1.": "mlp.c_fc.",
    "mlp.fc2.": "mlp.c_proj.",
}
_FOREIGN_ENDS = {
    "embeddings.token_embedding.weight": "token_embedding.weight",
    "embeddings.position_embedding.weight": "positional_embedding",
    "final_layer_norm.weight": "ln_final.weight",
    "final_layer_norm.bias": "ln_final.bias",
}


@dataclass(frozen=True)
class TextEncoderConfiguration:
    """Sizes; the defaults are those of Stable Diffusion 2.1.

    Attributes:
        width: channels of a token.
        layers: number of transformer layers that are used; the network was trained with one more.
        heads: of attention.
        tokens: of every prompt.
        vocabulary: number of different tokens.
    """

    width: int = 1024
    layers: int = 23
    heads: int = 16
    tokens: int = 77
    vocabulary: int = 49408


class _Block(nn.Module):
    def __init__(self, config: TextEncoderConfiguration) -> None:
        super().__init__()
        width = config.width
        self.ln_1, self.ln_2 = nn.LayerNorm(width), nn.LayerNorm(width)
        self.attn = nn.MultiheadAttention(width, config.heads, batch_first=True)
        layers = {"c_fc": nn.Linear(width, 4 * width), "gelu": nn.GELU(), "c_proj": nn.Linear(4 * width, width)}
        self.mlp = nn.Sequential(OrderedDict(layers))

    def forward(self, x: Tensor, future: Tensor) -> Tensor:
        normal = self.ln_1(x)
        x = x + self.attn(normal, normal, normal, need_weights=False, attn_mask=future)[0]
        return x + self.mlp(self.ln_2(x))


class _Blocks(nn.Module):
    def __init__(self, config: TextEncoderConfiguration) -> None:
        super().__init__()
        self.resblocks = nn.ModuleList(_Block(config) for _ in range(config.layers))


class TextEncoder(nn.Module):
    """Embeds prompts, under OpenCLIP's names."""

    def __init__(self, config: TextEncoderConfiguration) -> None:
        super().__init__()
        self.config = config
        self.token_embedding = nn.Embedding(config.vocabulary, config.width)
        self.positional_embedding = nn.Parameter(torch.zeros(config.tokens, config.width))
        self.transformer = _Blocks(config)
        self.ln_final = nn.LayerNorm(config.width)

    def forward(self, tokens: Tensor) -> Tensor:
        """Embed.

        Args:
            tokens: numbers of the prompt's words, shape [b, 77].

        Returns:
            Shape [b, 77, width].
        """
        x = self.token_embedding(tokens) + self.positional_embedding
        count = tokens.shape[1]
        future = torch.full((count, count), float("-inf"), device=x.device, dtype=x.dtype).triu(1)
        for block in self.transformer.resblocks:
            x = block(x, future)
        return self.ln_final(x)


def empty_prompt(count: int) -> Tensor:
    """The tokens of no words at all, shape [1, count]."""
    tokens = torch.full((1, count), _PADDING)
    tokens[0, 0], tokens[0, 1] = _START, _END
    return tokens


def text_weights(tensors: Mapping[str, Tensor], layers: int) -> dict[str, Tensor]:
    """The weights that ``TextEncoder`` uses, by its names.

    Args:
        tensors: a model file's, by OpenCLIP's names, or those of transformers (``text_model.*``).
        layers: number of layers that are used.
    """
    foreign = {name.split("text_model.", 1)[1]: each for name, each in tensors.items() if "text_model." in name}
    named = _from_transformers(foreign) if foreign else dict(tensors)
    parts = ("token_embedding.", "positional_embedding", "ln_final.")
    return {name: each for name, each in named.items() if name.startswith(parts) or -1 < _layer_of(name) < layers}


def _layer_of(name: str) -> int:
    found = re.match(r"transformer\.resblocks\.(\d+)\.", name)
    return int(found[1]) if found else -1


def _from_transformers(tensors: Mapping[str, Tensor]) -> dict[str, Tensor]:
    """OpenCLIP's names, in which queries, keys and values are one tensor."""
    named = {_FOREIGN_ENDS[name]: each for name, each in tensors.items() if name in _FOREIGN_ENDS}
    for name, each in tensors.items():
        found = re.match(r"encoder\.layers\.(\d+)\.(.*)", name)
        if not found:
            continue
        prefix, rest = f"transformer.resblocks.{found[1]}.", found[2]
        if rest.startswith("self_attn.q_proj."):
            three = [tensors[name.replace(".q_proj.", f".{letter}_proj.")] for letter in "qkv"]
            named[f"{prefix}attn.in_proj_{rest.rsplit('.', 1)[1]}"] = torch.cat(three)
        part = next((each for each in _FOREIGN_PARTS if rest.startswith(each)), None)
        if part:
            named[prefix + _FOREIGN_PARTS[part] + rest[len(part) :]] = each
    return named
