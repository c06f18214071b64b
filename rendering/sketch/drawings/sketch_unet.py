"""The U-Net of image-to-image translation (Isola et al., CVPR 2017) as line extractors for anime use it: Anime2Sketch
(Xiang et al., CVPR 2022), under its public weights' names.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn

from .configuration import SketchUNetConfiguration
from .line_network import LineNetwork

__all__ = ["SketchUNet"]


class SketchUNet(LineNetwork):
    """RGB in 0..1 becomes dark lines, 0, on paper, 1.

    Attributes:
        multiple: width and height must be multiples of this [px].
        least: the smallest width and height [px].
    """

    configuration = SketchUNetConfiguration
    first_convolution = "model.model.0.weight"
    wanted = "weights of a sketch U-Net"

    def __init__(self, config: SketchUNetConfiguration) -> None:
        super().__init__(config)
        self.multiple = self.least = 2**config.levels
        channels = config.level_channels
        block: nn.Module | None = None
        for level in range(config.levels - 1, 0, -1):
            block = _Level(channels[level - 1], channels[level], block)
        assert block is not None
        self.model = _Outermost(config.input_nc, channels[0], block, config.output_nc)

    def forward(self, picture: Tensor) -> Tensor:
        """Draw.

        Args:
            picture: RGB 0..1, shape [b, 3, h, w]; h and w multiples of ``multiple``.

        Returns:
            Lines 0, paper 1, shape [b, 1, h, w].
        """
        return (self.model(2 * picture - 1) + 1) / 2


class _Level(nn.Module):
    """Half the size, what is below it, and back; the input goes along beside the result."""

    def __init__(self, outer: int, inner: int, below: nn.Module | None) -> None:
        super().__init__()
        down: list[nn.Module] = [nn.LeakyReLU(0.2), nn.Conv2d(outer, inner, 4, stride=2, padding=1)]
        if below is not None:
            # The innermost level may be a single pixel, of which nothing would be left by normalising.
            down += [nn.InstanceNorm2d(inner), below]
        up = nn.ConvTranspose2d(inner if below is None else 2 * inner, outer, 4, stride=2, padding=1)
        self.model = nn.Sequential(*down, nn.ReLU(), up, nn.InstanceNorm2d(outer))

    def forward(self, x: Tensor) -> Tensor:
        return torch.cat([x, self.model(x)], dim=1)


class _Outermost(nn.Module):
    def __init__(self, input_nc: int, inner: int, below: nn.Module, output_nc: int) -> None:
        super().__init__()
        self.model = nn.Sequential(
            nn.Conv2d(input_nc, inner, 4, stride=2, padding=1),
            below,
            nn.ReLU(),
            nn.ConvTranspose2d(2 * inner, output_nc, 4, stride=2, padding=1),
            nn.Tanh(),
        )

    def forward(self, x: Tensor) -> Tensor:
        return self.model(x)
