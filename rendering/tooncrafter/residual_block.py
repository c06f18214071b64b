"""Residual blocks: within each frame, and a stack of convolutions over time behind it."""

from __future__ import annotations

from torch import Tensor, nn

from ..svd.residual_block import SpatialResidualBlock, normalised

__all__ = ["ResidualBlock", "TemporalConvolutions"]


class TemporalConvolutions(nn.Module):
    """Four convolutions over three frames each, around a residual connection."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        # All but the first have a place for dropout, which counts in the public names.
        self.conv1 = nn.Sequential(normalised(channels), nn.SiLU(), _over_time(channels))
        self.conv2, self.conv3, self.conv4 = (
            nn.Sequential(normalised(channels), nn.SiLU(), nn.Dropout(0), _over_time(channels)) for _ in range(3)
        )

    def forward(self, x: Tensor) -> Tensor:
        """x: features, shape [b, c, t, h, w]."""
        return x + self.conv4(self.conv3(self.conv2(self.conv1(x))))


class ResidualBlock(SpatialResidualBlock):
    """Residual block that is told the noise level."""

    def __init__(self, channels_in: int, channels_out: int, embedding_channels: int, *, temporal: bool) -> None:
        """Prepare the block.

        Args:
            channels_in: of its input.
            channels_out: of its output.
            embedding_channels: of the embedded noise level.
            temporal: whether convolutions over time follow.
        """
        super().__init__(channels_in, channels_out, embedding_channels)
        self.temopral_conv = TemporalConvolutions(channels_out) if temporal else None  # (sic) the public name

    def forward(self, x: Tensor, embedding: Tensor, frames: int) -> Tensor:
        """Apply.

        Args:
            x: features, shape [b * t, c, h, w].
            embedding: of each frame, shape [b * t, e].
            frames: t.
        """
        h = self.spatial(x, embedding)
        if self.temopral_conv is None:
            return h
        clip = h.unflatten(0, (-1, frames)).transpose(1, 2)
        return self.temopral_conv(clip).transpose(1, 2).flatten(0, 1)


def _over_time(channels: int) -> nn.Conv3d:
    return nn.Conv3d(channels, channels, (3, 1, 1), padding=(1, 0, 0))
