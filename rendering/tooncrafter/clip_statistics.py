"""Group normalisation of a clip that is seen in parts."""

from __future__ import annotations

import torch
from torch import Tensor, nn

__all__ = ["ClipStatistics"]


class ClipStatistics:
    """Mean and variance of each group of channels over all parts, put together as Chan et al. do ("Updating formulae
    and a pairwise algorithm for computing sample variances", 1979): nothing cancels, whatever the parts' number."""

    def __init__(self, norm: nn.GroupNorm) -> None:
        self._norm, self._count = norm, 0
        zero = torch.zeros(norm.num_groups, dtype=torch.float64, device=norm.weight.device)
        self._mean, self._squares = zero, zero

    def add(self, part: Tensor) -> None:
        """Another part of the clip, shape [1, c, ...]."""
        groups = part.float().reshape(self._norm.num_groups, -1)
        variance, mean = (each.double() for each in torch.var_mean(groups, dim=1, correction=0))
        count = groups.shape[1]
        total = self._count + count
        apart = mean - self._mean
        self._squares = self._squares + count * variance + apart.square() * (self._count * count / total)
        self._mean = self._mean + apart * (count / total)
        self._count = total

    def normalised(self, part: Tensor) -> Tensor:
        """A part, normalised with the statistics of all, shape [1, c, ...], in single precision."""
        each = self._norm.num_channels // self._norm.num_groups
        deviation = (self._squares / self._count + self._norm.eps).sqrt()
        scale = self._norm.weight / deviation.repeat_interleave(each)
        shift = self._norm.bias - self._mean.repeat_interleave(each) * scale
        around = (1, -1, *[1] * (part.ndim - 2))
        return (part.float() * scale.float().view(around)).add_(shift.float().view(around))
