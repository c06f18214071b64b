"""The generator of "Learning to generate line drawings that convey geometry and semantics" (Chan, Durand and Isola,
CVPR 2022): a residual network between two strided and two transposed convolutions, under its public weights' names.
"""

from __future__ import annotations

from torch import Tensor, nn

from .configuration import InformativeDrawingsConfiguration
from .line_network import LineNetwork

__all__ = ["InformativeDrawings"]


class InformativeDrawings(LineNetwork):
    """RGB in 0..1 becomes dark lines, 0, on paper, 1.

    Attributes:
        multiple: width and height must be multiples of this [px].
        least: the smallest width and height, which reflections at the border need [px].
    """

    multiple, least = 4, 8

    configuration = InformativeDrawingsConfiguration
    first_convolution = "model0.1.weight"
    wanted = "weights of informative drawings"

    def __init__(self, config: InformativeDrawingsConfiguration) -> None:
        super().__init__(config)
        width = config.base_channels
        self.model0 = nn.Sequential(nn.ReflectionPad2d(3), nn.Conv2d(config.input_nc, width, 7), *_normalised(width))
        self.model1 = nn.Sequential(*_halved(width), *_halved(2 * width))
        self.model2 = nn.Sequential(*(_ResidualBlock(4 * width) for _ in range(config.n_residual_blocks)))
        self.model3 = nn.Sequential(*_doubled(4 * width), *_doubled(2 * width))
        last: list[nn.Module] = [nn.ReflectionPad2d(3), nn.Conv2d(width, config.output_nc, 7)]
        self.model4 = nn.Sequential(*last, *([nn.Sigmoid()] if config.sigmoid else []))

    def forward(self, picture: Tensor) -> Tensor:
        """Draw.

        Args:
            picture: RGB 0..1, shape [b, 3, h, w]; h and w multiples of 4 and at least 8.

        Returns:
            Lines 0, paper 1, shape [b, 1, h, w].
        """
        return self.model4(self.model3(self.model2(self.model1(self.model0(picture)))))


class _ResidualBlock(nn.Module):
    def __init__(self, channels: int) -> None:
        super().__init__()
        self.conv_block = nn.Sequential(
            nn.ReflectionPad2d(1),
            nn.Conv2d(channels, channels, 3),
            *_normalised(channels),
            nn.ReflectionPad2d(1),
            nn.Conv2d(channels, channels, 3),
            nn.InstanceNorm2d(channels),
        )

    def forward(self, x: Tensor) -> Tensor:
        return x + self.conv_block(x)


def _normalised(channels: int) -> tuple[nn.Module, ...]:
    return nn.InstanceNorm2d(channels), nn.ReLU(inplace=True)


def _halved(channels: int) -> tuple[nn.Module, ...]:
    return nn.Conv2d(channels, 2 * channels, 3, stride=2, padding=1), *_normalised(2 * channels)


def _doubled(channels: int) -> tuple[nn.Module, ...]:
    up = nn.ConvTranspose2d(channels, channels // 2, 3, stride=2, padding=1, output_padding=1)
    return up, *_normalised(channels // 2)
