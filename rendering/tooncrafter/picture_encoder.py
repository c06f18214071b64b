"""The autoencoder's first half: each picture by itself."""

from __future__ import annotations

from torch import Tensor, nn
from torch.nn import functional

from ..svd.residual_block import normalised
from .autoencoder_blocks import Level, Middle, PictureBlock
from .configuration import AutoencoderConfiguration

__all__ = ["PictureEncoder"]


class _Downsample(nn.Module):
    """Half the height and width; the added row and column are at the far ends only."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.conv = nn.Conv2d(channels, channels, 3, stride=2)

    def forward(self, x: Tensor) -> Tensor:
        return self.conv(functional.pad(x, (0, 1, 0, 1)))


class PictureEncoder(nn.Module):
    """Pictures to features of all levels."""

    def __init__(self, config: AutoencoderConfiguration) -> None:
        super().__init__()
        levels, last = config.level_channels, config.level_channels[-1]
        self.conv_in = nn.Conv2d(3, config.ch, 3, padding=1)
        self.down = nn.ModuleList()
        channels = config.ch
        for number, width in enumerate(levels):
            blocks = [PictureBlock(channels if not each else width, width) for each in range(config.num_res_blocks)]
            self.down.append(Level(blocks, downsample=_Downsample(width) if number + 1 < len(levels) else None))
            channels = width
        self.mid = Middle(PictureBlock, last)
        self.norm_out = normalised(last, epsilon=1e-6)
        self.conv_out = nn.Conv2d(last, 2 * config.z_channels, 3, padding=1)

    def forward(self, x: Tensor) -> tuple[Tensor, list[Tensor]]:
        """x: pictures, shape [t, 3, h, w]; means and logarithms of variances, and features, shapes [t, c, h', w']."""
        entrance = x = self.conv_in(x)
        features = []
        for level in self.down:
            assert isinstance(level, Level)
            x = level(x)
            features.append(x)
            if level.downsample is not None:
                x = level.downsample(x)
        x = functional.silu(self.norm_out(self.mid(x)))
        return self.conv_out(x), [*features, entrance]
