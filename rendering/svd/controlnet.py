"""The sketch ControlNet of LVCD: a copy of the UNet's encoder that reads sketches (LVCD, Section 3.1)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

from torch import Tensor, nn

from ..networks.checkpoints import network_of
from .configuration import NetworkConfiguration
from .encoder import SpatioTemporalEncoder
from .frame_layout import FrameLayout

__all__ = ["SketchControlNet", "hint_layers", "zero_convolution"]

# The layers that read a sketch, as in ControlNet (Zhang et al., 2023): down to an eighth of the size.
_HINT_CHANNELS = (16, 16, 32, 32, 96, 96, 256)
_HINT_STRIDES = (1, 1, 2, 1, 2, 1, 2, 1)


class SketchControlNet(SpatioTemporalEncoder):
    """What sketches add to the UNet's skips and middle; nothing at the start of its training."""

    prefix = "control_model."
    """Before its names in the public checkpoint."""

    def __init__(self, config: NetworkConfiguration) -> None:
        super().__init__(config)
        self.input_hint_block = nn.Sequential(*hint_layers(config.hint_channels, config.model_channels))
        self.zero_convs = nn.ModuleList(zero_convolution(channels) for channels in self.skip_channels)
        self.middle_block_out = zero_convolution(config.level_channels[-1])

    @classmethod
    def from_reference(
        cls, config: NetworkConfiguration | Mapping[str, Any], state_dict: Mapping[str, Any]
    ) -> SketchControlNet:
        """A network with the weights of a state dict, whose names are the public checkpoint's, prefix included."""
        return network_of(
            lambda: cls(NetworkConfiguration.of(config)),
            state_dict,
            wanted="weights of the sketch ControlNet",
            prefix=cls.prefix,
        )

    def forward(
        self, x: Tensor, hint: Tensor, noise_level: Tensor, context: Tensor, ids: Tensor, layout: FrameLayout
    ) -> list[Tensor]:
        """Read the sketches.

        Args:
            x: scaled noisy latents, then condition latents, shape [b, t, 8, h, w].
            hint: sketches, lines 1 on 0, shape [b, t, 3, 8 h, 8 w].
            noise_level: ln(sigma) / 4 of each video, shape [b].
            context: embedding of each video's picture, shape [b, l, c].
            ids: frames per second, motion bucket and noise of the picture, shape [b, 3].
            layout: the segment's frames.

        Returns:
            One residual for each skip of the UNet, then one for its middle, shapes [b * t, c, h', w'].
        """
        conditions = self.conditions(noise_level, context, ids, layout)
        guide = self.input_hint_block(hint.flatten(0, 1))
        skips, middle = self.encode(x.flatten(0, 1), conditions, guide)
        residuals = [convolution(skip) for convolution, skip in zip(self.zero_convs, skips, strict=True)]
        return [*residuals, self.middle_block_out(middle)]


def hint_layers(hint_channels: int, model_channels: int) -> Iterator[nn.Module]:
    """Convolutions from picture to latent resolution, a SiLU between each two."""
    widths = (hint_channels, *_HINT_CHANNELS, model_channels)
    for number, ((before, after), stride) in enumerate(zip(pairwise(widths), _HINT_STRIDES, strict=True)):
        if number:
            yield nn.SiLU()
        yield nn.Conv2d(before, after, 3, stride=stride, padding=1)


def zero_convolution(channels: int) -> nn.Sequential:
    """Zero before training; real weights are assigned."""
    convolution = nn.Conv2d(channels, channels, 1)
    nn.init.zeros_(convolution.weight)
    assert convolution.bias is not None
    nn.init.zeros_(convolution.bias)
    return nn.Sequential(convolution)
