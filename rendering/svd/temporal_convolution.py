"""Convolution over time in which nothing leaks from or to reference frames (LVCD, Section 3.2)."""

from __future__ import annotations

import torch
from torch import Tensor, nn
from torch.nn import functional

__all__ = ["MaskedTemporalConvolution"]


class MaskedTemporalConvolution(nn.Conv3d):
    """A convolution over frames alone, kernel [k, 1, 1]; reference frames are sequences of length one."""

    def __init__(self, channels_in: int, channels_out: int, kernel: tuple[int, int, int]) -> None:
        super().__init__(channels_in, channels_out, kernel, padding=(kernel[0] // 2, 0, 0))

    def forward(self, x: Tensor, references: int) -> Tensor:  # type: ignore[override]
        """Convolve the clip as its own zero-padded sequence.

        Args:
            x: features, shape [b, c, t, h, w].
            references: number of leading frames that are convolved one by one.
        """
        if not references:
            return super().forward(x)
        middle = self.kernel_size[0] // 2
        alone = functional.conv3d(x[:, :, :references], self.weight[:, :, middle : middle + 1], self.bias)
        return torch.cat([alone, super().forward(x[:, :, references:])], dim=2)
