"""The autoencoder whose decoder sees both keyframes (ToonCrafter, "dual-reference-based 3D decoder")."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import torch
from torch import Tensor, nn
from torch.nn import functional

from ..checkpoints import assign, below, build_without_storage
from ..svd.residual_block import normalised
from ..svd.unet import Upsample
from .autoencoder_blocks import PictureAttention, PictureBlock, VideoBlock
from .configuration import AutoencoderConfiguration
from .reference_features import AddReferences, AttendToReferences

__all__ = ["DualReferenceAutoencoder"]


class DualReferenceAutoencoder(nn.Module):
    """Pictures to latents, and latents with both keyframes' features to pictures."""

    prefix = "first_stage_model."
    """Before its names in the public checkpoint."""

    def __init__(self, config: AutoencoderConfiguration) -> None:
        super().__init__()
        self.config = config
        self.encoder = _Encoder(config)
        self.decoder = _Decoder(config)
        self.quant_conv = nn.Conv2d(2 * config.z_channels, 2 * config.embed_dim, 1)
        # Part of the public file, without use: the decoder was trained on the latents as they are.
        self.post_quant_conv = nn.Conv2d(config.embed_dim, config.z_channels, 1)

    @classmethod
    def from_reference(
        cls, config: AutoencoderConfiguration | Mapping[str, Any], state_dict: Mapping[str, Any]
    ) -> DualReferenceAutoencoder:
        """A network with the weights of a state dict, whose names are the public checkpoint's, prefix included."""
        network = build_without_storage(lambda: cls(AutoencoderConfiguration.of(config)))
        tensors = {name: torch.as_tensor(value) for name, value in state_dict.items()}
        assign(
            network, below(tensors, cls.prefix), file="the state dict", wanted="weights of ToonCrafter's autoencoder"
        )
        return network

    def encode(self, frames: Tensor) -> tuple[Tensor, list[Tensor]]:
        """Encode pictures; the first and the last are the keyframes.

        Args:
            frames: -1..1, shape [t, 3, h, w].

        Returns:
            Means and logarithms of variances, one after the other, shape [t, 8, h / 8, w / 8]; and the features of both
            keyframes on each level, then at the entrance, shapes [1, c, 2, h', w'].
        """
        h, features = self.encoder(frames)
        references = [torch.stack([each[0], each[-1]], dim=1)[None] for each in features]
        return self.quant_conv(h), references

    def decode(self, latents: Tensor, references: Sequence[Tensor]) -> Tensor:
        """Decode one clip.

        Args:
            latents: not scaled, shape [t, 4, h, w].
            references: features of both keyframes, from ``encode``.

        Returns:
            Pictures, about -1..1, shape [t, 3, 8 h, 8 w].
        """
        return self.decoder(latents, references)


class _Downsample(nn.Module):
    """Half the height and width; the added row and column are at the far ends only."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.conv = nn.Conv2d(channels, channels, 3, stride=2)

    def forward(self, x: Tensor) -> Tensor:
        return self.conv(functional.pad(x, (0, 1, 0, 1)))


class _Level(nn.Module):
    """Blocks of one level and, but for the last, the way to the next."""

    def __init__(
        self, blocks: Sequence[nn.Module], downsample: nn.Module | None = None, upsample: nn.Module | None = None
    ) -> None:
        super().__init__()
        self.block = nn.ModuleList(blocks)
        self.downsample = downsample
        self.upsample = upsample

    def forward(self, x: Tensor) -> Tensor:
        """The blocks alone."""
        for block in self.block:
            x = block(x)
        return x


class _Middle(nn.Module):
    def __init__(self, block: type[PictureBlock], channels: int) -> None:
        super().__init__()
        self.block_1, self.block_2 = block(channels, channels), block(channels, channels)
        self.attn_1 = PictureAttention(channels)

    def forward(self, x: Tensor) -> Tensor:
        return self.block_2(self.attn_1(self.block_1(x)))


class _Encoder(nn.Module):
    def __init__(self, config: AutoencoderConfiguration) -> None:
        super().__init__()
        levels, last = config.level_channels, config.level_channels[-1]
        self.conv_in = nn.Conv2d(3, config.ch, 3, padding=1)
        self.down = nn.ModuleList()
        channels = config.ch
        for number, width in enumerate(levels):
            blocks = [PictureBlock(channels if not each else width, width) for each in range(config.num_res_blocks)]
            self.down.append(_Level(blocks, downsample=_Downsample(width) if number + 1 < len(levels) else None))
            channels = width
        self.mid = _Middle(PictureBlock, last)
        self.norm_out = normalised(last, epsilon=1e-6)
        self.conv_out = nn.Conv2d(last, 2 * config.z_channels, 3, padding=1)

    def forward(self, x: Tensor) -> tuple[Tensor, list[Tensor]]:
        entrance = x = self.conv_in(x)
        features = []
        for level in self.down:
            assert isinstance(level, _Level)
            x = level(x)
            features.append(x)
            if level.downsample is not None:
                x = level.downsample(x)
        x = functional.silu(self.norm_out(self.mid(x)))
        return self.conv_out(x), [*features, entrance]


class _LastConvolution(nn.Conv2d):
    """To colours, then over time."""

    def __init__(self, channels: int) -> None:
        super().__init__(channels, 3, 3, padding=1)
        self.time_mix_conv = nn.Conv3d(3, 3, (3, 1, 1), padding=(1, 0, 0))

    def forward(self, x: Tensor) -> Tensor:
        pictures = super().forward(x)
        return self.time_mix_conv(pictures.transpose(0, 1)[None])[0].transpose(0, 1)


class _Decoder(nn.Module):
    def __init__(self, config: AutoencoderConfiguration) -> None:
        super().__init__()
        levels, channels = config.level_channels, config.level_channels[-1]
        self.conv_in = nn.Conv2d(config.z_channels, channels, 3, padding=1)
        self.mid = _Middle(VideoBlock, channels)
        up = []
        for number, width in reversed(list(enumerate(levels))):
            blocks = [VideoBlock(channels if not each else width, width) for each in range(config.num_res_blocks + 1)]
            up.append(_Level(blocks, upsample=Upsample(width) if number else None))
            channels = width
        self.up = nn.ModuleList(reversed(up))
        refinements = [
            AttendToReferences(width, config) if number in config.fusion_levels else AddReferences(width)
            for number, width in enumerate(levels)
        ]
        self.attn_refinement = nn.ModuleList([*refinements, AddReferences(channels)])
        self.norm_out = normalised(channels, epsilon=1e-6)
        self.conv_out = _LastConvolution(channels)

    def forward(self, x: Tensor, references: Sequence[Tensor]) -> Tensor:
        x = self.mid(self.conv_in(x))
        for number in reversed(range(len(self.up))):
            level = self.up[number]
            assert isinstance(level, _Level)
            x = self.attn_refinement[number](level(x), references[number])
            if level.upsample is not None:
                x = level.upsample(x)
        x = functional.silu(self.norm_out(x))
        return self.conv_out(self.attn_refinement[len(self.up)](x, references[-1]))
