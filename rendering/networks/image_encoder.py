"""The picture encoder of CLIP (Radford et al. 2021; OpenCLIP's ViT-H/14 in Stable Video Diffusion)."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn
from torch.nn import functional

__all__ = ["ImageEncoder", "ImageEncoderConfiguration", "encoder_picture", "square_picture"]

# Of the colours that CLIP was trained on (Radford et al., 2021), red, green and blue.
_MEAN = (0.48145466, 0.4578275, 0.40821073)
_DEVIATION = (0.26862954, 0.26130258, 0.27577711)


@dataclass(frozen=True)
class ImageEncoderConfiguration:
    """Sizes; the defaults are those of ViT-H/14.

    Attributes:
        width: channels of a token.
        layers: number of transformer layers.
        heads: of attention.
        hidden: channels between the two linear layers after attention.
        patch: width of the square that becomes a token [px].
        picture: width of the picture [px].
        projection: channels of the embedding.
    """

    width: int = 1280
    layers: int = 32
    heads: int = 16
    hidden: int = 5120
    patch: int = 14
    picture: int = 224
    projection: int = 1024


class _Attention(nn.Module):
    def __init__(self, width: int, heads: int) -> None:
        super().__init__()
        self.heads = heads
        self.q_proj, self.k_proj, self.v_proj, self.out_proj = (nn.Linear(width, width) for _ in range(4))

    def forward(self, x: Tensor) -> Tensor:
        projected = (project(x) for project in (self.q_proj, self.k_proj, self.v_proj))
        q, k, v = (each.unflatten(-1, (self.heads, -1)).transpose(1, 2) for each in projected)
        mixed = functional.scaled_dot_product_attention(q, k, v)
        return self.out_proj(mixed.transpose(1, 2).flatten(2))


class _Perceptron(nn.Module):
    def __init__(self, width: int, hidden: int) -> None:
        super().__init__()
        self.fc1, self.fc2 = nn.Linear(width, hidden), nn.Linear(hidden, width)

    def forward(self, x: Tensor) -> Tensor:
        return self.fc2(functional.gelu(self.fc1(x)))


class _Layer(nn.Module):
    def __init__(self, config: ImageEncoderConfiguration) -> None:
        super().__init__()
        self.layer_norm1, self.layer_norm2 = nn.LayerNorm(config.width), nn.LayerNorm(config.width)
        self.self_attn = _Attention(config.width, config.heads)
        self.mlp = _Perceptron(config.width, config.hidden)

    def forward(self, x: Tensor) -> Tensor:
        x = x + self.self_attn(self.layer_norm1(x))
        return x + self.mlp(self.layer_norm2(x))


class _Embeddings(nn.Module):
    """Patches and one more token, each told its place."""

    def __init__(self, config: ImageEncoderConfiguration) -> None:
        super().__init__()
        self.class_embedding = nn.Parameter(torch.zeros(config.width))
        self.patch_embedding = nn.Conv2d(3, config.width, config.patch, stride=config.patch, bias=False)
        self.position_embedding = nn.Embedding((config.picture // config.patch) ** 2 + 1, config.width)

    def forward(self, picture: Tensor) -> Tensor:
        patches = self.patch_embedding(picture).flatten(2).transpose(1, 2)
        tokens = torch.cat([self.class_embedding.expand(len(patches), 1, -1), patches], dim=1)
        return tokens + self.position_embedding.weight


class _Layers(nn.Module):
    def __init__(self, config: ImageEncoderConfiguration) -> None:
        super().__init__()
        self.layers = nn.ModuleList(_Layer(config) for _ in range(config.layers))

    def forward(self, x: Tensor) -> Tensor:
        for layer in self.layers:
            x = layer(x)
        return x


class _VisionModel(nn.Module):
    def __init__(self, config: ImageEncoderConfiguration) -> None:
        super().__init__()
        self.embeddings = _Embeddings(config)
        self.pre_layrnorm = nn.LayerNorm(config.width)  # (sic) the checkpoints' spelling
        self.encoder = _Layers(config)
        self.post_layernorm = nn.LayerNorm(config.width)

    def forward(self, picture: Tensor) -> Tensor:
        return self.post_layernorm(self.tokens(picture)[:, 0])

    def tokens(self, picture: Tensor) -> Tensor:
        return self.encoder(self.pre_layrnorm(self.embeddings(picture)))


class ImageEncoder(nn.Module):
    """Embeds a whole picture, under the names of the diffusers folder's checkpoint."""

    def __init__(self, config: ImageEncoderConfiguration) -> None:
        super().__init__()
        self.config = config
        self.vision_model = _VisionModel(config)
        self.visual_projection = nn.Linear(config.width, config.projection, bias=False)

    def forward(self, picture: Tensor) -> Tensor:
        """Embed pictures that ``encoder_picture`` has prepared, shape [b, 3, h, h], as [b, projection]."""
        return self.visual_projection(self.vision_model(picture))

    def tokens(self, picture: Tensor) -> Tensor:
        """All tokens of such pictures after the last layer, not normalised, shape [b, n, width]."""
        return self.vision_model.tokens(picture)


def encoder_picture(picture: Tensor, size: int) -> Tensor:
    """A picture in the size and colours that the encoder knows.

    Args:
        picture: -1..1, shape [b, 3, h, w].
        size: width and height of the result [px]; other proportions are squeezed, as in the encoder's use in training.
    """
    shrunk = square_picture(picture, size)
    mean, deviation = (shrunk.new_tensor(each)[:, None, None] for each in (_MEAN, _DEVIATION))
    return ((shrunk + 1) / 2 - mean) / deviation


def square_picture(picture: Tensor, size: int) -> Tensor:
    """A picture, shape [b, 3, h, w], in the encoder's size, with the colours that it had."""
    return functional.interpolate(_smoothed(picture, size), (size, size), mode="bicubic", align_corners=True)


def _smoothed(picture: Tensor, size: int) -> Tensor:
    """Gaussian blur that keeps details from aliasing when the picture shrinks; none when it grows."""
    factors = [length / size for length in picture.shape[-2:]]
    if max(factors) <= 1:
        return picture
    sigmas = [max((factor - 1) / 2, 1e-3) for factor in factors]
    reach = [int(max(4 * sigma, 3)) // 2 for sigma in sigmas]
    vertical, horizontal = (_gaussian(sigma, each, picture) for sigma, each in zip(sigmas, reach, strict=True))
    padded = functional.pad(picture, (reach[1], reach[1], reach[0], reach[0]), mode="reflect")
    blurred = functional.conv2d(padded, vertical[:, None].expand(3, 1, -1, 1), groups=3)
    return functional.conv2d(blurred, horizontal[None].expand(3, 1, 1, -1), groups=3)


def _gaussian(sigma: float, reach: int, like: Tensor) -> Tensor:
    place = torch.arange(-reach, reach + 1, device=like.device, dtype=like.dtype)
    weight = (-(place**2) / (2 * sigma**2)).exp()
    return weight / weight.sum()
