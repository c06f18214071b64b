"""The autoencoder's second half: a clip, whose layers see time and both keyframes."""

from __future__ import annotations

from collections.abc import Sequence

from torch import Tensor, nn
from torch.nn import functional

from ..svd.residual_block import normalised
from ..svd.unet import Upsample
from .autoencoder_blocks import Level, Middle, VideoBlock
from .clip_features import ClipFeatures
from .configuration import AutoencoderConfiguration
from .reference_features import AddReferences, AttendToReferences

__all__ = ["ClipDecoder"]


class _LastConvolution(nn.Conv2d):
    """To colours, then over time."""

    def __init__(self, channels: int) -> None:
        super().__init__(channels, 3, 3, padding=1)
        self.time_mix_conv = nn.Conv3d(3, 3, (3, 1, 1), padding=(1, 0, 0))

    def over_time(self, pictures: Tensor) -> Tensor:
        """Mix the colours of a clip, shape [t, 3, h, w]."""
        return self.time_mix_conv(pictures.transpose(0, 1)[None])[0].transpose(0, 1)


class ClipDecoder(nn.Module):
    """Latents of a clip and features of its keyframes to pictures."""

    def __init__(self, config: AutoencoderConfiguration) -> None:
        super().__init__()
        levels, channels = config.level_channels, config.level_channels[-1]
        self.conv_in = nn.Conv2d(config.z_channels, channels, 3, padding=1)
        self.mid = Middle(VideoBlock, channels)
        up = []
        for number, width in reversed(list(enumerate(levels))):
            blocks = [VideoBlock(channels if not each else width, width) for each in range(config.num_res_blocks + 1)]
            up.append(Level(blocks, upsample=Upsample(width) if number else None))
            channels = width
        self.up = nn.ModuleList(reversed(up))
        refinements = [
            AttendToReferences(width, config) if number in config.fusion_levels else AddReferences(width)
            for number, width in enumerate(levels)
        ]
        self.attn_refinement = nn.ModuleList([*refinements, AddReferences(channels)])
        self.norm_out = normalised(channels, epsilon=1e-6)
        self.conv_out = _LastConvolution(channels)

    def forward(self, x: Tensor, references: Sequence[Tensor], budget: int | None) -> Tensor:
        """budget: about how many numbers a layer's result may hold; None computes all frames at once."""
        features = ClipFeatures(x, budget)
        features.then(self.conv_in)
        self.mid.over_clip(features)
        for number in reversed(range(len(self.up))):
            level = self.up[number]
            assert isinstance(level, Level)
            for block in level.block:
                block(features)
            _refine(self.attn_refinement[number], features, references[number])
            if level.upsample is not None:
                features.then(level.upsample)
        features.then(self.norm_out, functional.silu)
        _refine(self.attn_refinement[len(self.up)], features, references[-1])
        features.then(self.conv_out)
        return self.conv_out.over_time(features.settled())


def _refine(refinement: nn.Module, features: ClipFeatures, references: Tensor) -> None:
    """Let the keyframes' features into those of a clip."""
    if isinstance(refinement, AttendToReferences):
        keys, values = refinement.keys_and_values(references)
        features.then(lambda x: refinement(x, keys, values))
    else:
        refinement(features, references)
