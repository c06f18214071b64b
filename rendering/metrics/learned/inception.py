"""Inception v3 (Szegedy et al., CVPR 2016) as the Frechet inception distance uses it, up to its pooled features.

The public weights were converted from the original ones of 2015, whose average pools leave the border out and whose
last block pools by the maximum.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import torch
from torch import Tensor, nn
from torch.nn import functional

from ...networks.checkpoints import network_of
from .files import FID_FILE

__all__ = ["FEATURES", "InceptionFeatures"]

FEATURES = 2048
"""Length of a picture's description."""

_SIDE = 299
_NOT_USED = ("fc.", "AuxLogits.")
_WANTED = f"{FID_FILE.name} from {FID_FILE.page}"

Kernel = int | tuple[int, int]


class InceptionFeatures(nn.Module):
    """Describes pictures by 2048 numbers each, under the public weights' names."""

    def __init__(self) -> None:
        super().__init__()
        self.Conv2d_1a_3x3 = _Convolution(3, 32, 3, stride=2)
        self.Conv2d_2a_3x3 = _Convolution(32, 32, 3)
        self.Conv2d_2b_3x3 = _Convolution(32, 64, 3, padding=1)
        self.Conv2d_3b_1x1 = _Convolution(64, 80, 1)
        self.Conv2d_4a_3x3 = _Convolution(80, 192, 3)
        self.Mixed_5b, self.Mixed_5c, self.Mixed_5d = _Wide(192, 32), _Wide(256, 64), _Wide(288, 64)
        self.Mixed_6a = _FirstReduction(288)
        self.Mixed_6b, self.Mixed_6c = _Long(128), _Long(160)
        self.Mixed_6d, self.Mixed_6e = _Long(160), _Long(192)
        self.Mixed_7a = _SecondReduction(768)
        self.Mixed_7b, self.Mixed_7c = _Split(1280, by_maximum=False), _Split(2048, by_maximum=True)

    @classmethod
    def from_reference(cls, state_dict: Mapping[str, Any], *, file: str = "the state dict") -> InceptionFeatures:
        """A network with the public weights; the classifier, which the features do not need, is left out.

        Raises:
            CheckpointError: a name is missing, too many, or its tensor has another shape.
        """
        tensors = {
            name: value
            for name, value in state_dict.items()
            if not name.startswith(_NOT_USED) and not name.endswith("num_batches_tracked")
        }
        return network_of(cls, tensors, file=file, wanted=_WANTED)

    def forward(self, pictures: Tensor) -> Tensor:
        """Describe pictures.

        Args:
            pictures: RGB 0..1, shape [b, 3, h, w], of any size.

        Returns:
            Features, shape [b, 2048].
        """
        x = functional.interpolate(pictures, size=(_SIDE, _SIDE), mode="bilinear", align_corners=False)
        x = self.Conv2d_2b_3x3(self.Conv2d_2a_3x3(self.Conv2d_1a_3x3(2 * x - 1)))
        x = self.Conv2d_4a_3x3(self.Conv2d_3b_1x1(functional.max_pool2d(x, 3, stride=2)))
        x = self.Mixed_5d(self.Mixed_5c(self.Mixed_5b(functional.max_pool2d(x, 3, stride=2))))
        x = self.Mixed_6e(self.Mixed_6d(self.Mixed_6c(self.Mixed_6b(self.Mixed_6a(x)))))
        return self.Mixed_7c(self.Mixed_7b(self.Mixed_7a(x))).mean(dim=(2, 3))


class _Convolution(nn.Module):
    """A convolution, normalised by known statistics, and its positive part."""

    def __init__(self, given: int, made: int, kernel: Kernel, *, stride: int = 1, padding: Kernel = 0) -> None:
        super().__init__()
        self.conv = nn.Conv2d(given, made, kernel, stride=stride, padding=padding, bias=False)
        self.bn = _KnownStatistics(made)

    def forward(self, x: Tensor) -> Tensor:
        return functional.relu(self.bn(self.conv(x)))


class _KnownStatistics(nn.Module):
    """Batch normalisation that has been learned."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.weight, self.bias = nn.Parameter(torch.ones(channels)), nn.Parameter(torch.zeros(channels))
        self.register_buffer("running_mean", torch.zeros(channels))
        self.register_buffer("running_var", torch.ones(channels))

    def forward(self, x: Tensor) -> Tensor:
        mean, variance = self.get_buffer("running_mean"), self.get_buffer("running_var")
        return functional.batch_norm(x, mean, variance, self.weight, self.bias, eps=0.001)


def _average(x: Tensor) -> Tensor:
    return functional.avg_pool2d(x, 3, stride=1, padding=1, count_include_pad=False)


class _Wide(nn.Module):
    def __init__(self, given: int, pooled: int) -> None:
        super().__init__()
        self.branch1x1 = _Convolution(given, 64, 1)
        self.branch5x5_1 = _Convolution(given, 48, 1)
        self.branch5x5_2 = _Convolution(48, 64, 5, padding=2)
        self.branch3x3dbl_1 = _Convolution(given, 64, 1)
        self.branch3x3dbl_2 = _Convolution(64, 96, 3, padding=1)
        self.branch3x3dbl_3 = _Convolution(96, 96, 3, padding=1)
        self.branch_pool = _Convolution(given, pooled, 1)

    def forward(self, x: Tensor) -> Tensor:
        double = self.branch3x3dbl_3(self.branch3x3dbl_2(self.branch3x3dbl_1(x)))
        return torch.cat(
            [self.branch1x1(x), self.branch5x5_2(self.branch5x5_1(x)), double, self.branch_pool(_average(x))], dim=1
        )


class _FirstReduction(nn.Module):
    def __init__(self, given: int) -> None:
        super().__init__()
        self.branch3x3 = _Convolution(given, 384, 3, stride=2)
        self.branch3x3dbl_1 = _Convolution(given, 64, 1)
        self.branch3x3dbl_2 = _Convolution(64, 96, 3, padding=1)
        self.branch3x3dbl_3 = _Convolution(96, 96, 3, stride=2)

    def forward(self, x: Tensor) -> Tensor:
        double = self.branch3x3dbl_3(self.branch3x3dbl_2(self.branch3x3dbl_1(x)))
        return torch.cat([self.branch3x3(x), double, functional.max_pool2d(x, 3, stride=2)], dim=1)


class _Long(nn.Module):
    """Kernels of 7 pixels, across and down."""

    def __init__(self, inner: int) -> None:
        super().__init__()
        across: dict[str, Any] = {"kernel": (1, 7), "padding": (0, 3)}
        down: dict[str, Any] = {"kernel": (7, 1), "padding": (3, 0)}
        self.branch1x1 = _Convolution(768, 192, 1)
        self.branch7x7_1 = _Convolution(768, inner, 1)
        self.branch7x7_2 = _Convolution(inner, inner, **across)
        self.branch7x7_3 = _Convolution(inner, 192, **down)
        self.branch7x7dbl_1 = _Convolution(768, inner, 1)
        self.branch7x7dbl_2 = _Convolution(inner, inner, **down)
        self.branch7x7dbl_3 = _Convolution(inner, inner, **across)
        self.branch7x7dbl_4 = _Convolution(inner, inner, **down)
        self.branch7x7dbl_5 = _Convolution(inner, 192, **across)
        self.branch_pool = _Convolution(768, 192, 1)

    def forward(self, x: Tensor) -> Tensor:
        single = self.branch7x7_3(self.branch7x7_2(self.branch7x7_1(x)))
        double = self.branch7x7dbl_3(self.branch7x7dbl_2(self.branch7x7dbl_1(x)))
        double = self.branch7x7dbl_5(self.branch7x7dbl_4(double))
        return torch.cat([self.branch1x1(x), single, double, self.branch_pool(_average(x))], dim=1)


class _SecondReduction(nn.Module):
    def __init__(self, given: int) -> None:
        super().__init__()
        self.branch3x3_1 = _Convolution(given, 192, 1)
        self.branch3x3_2 = _Convolution(192, 320, 3, stride=2)
        self.branch7x7x3_1 = _Convolution(given, 192, 1)
        self.branch7x7x3_2 = _Convolution(192, 192, (1, 7), padding=(0, 3))
        self.branch7x7x3_3 = _Convolution(192, 192, (7, 1), padding=(3, 0))
        self.branch7x7x3_4 = _Convolution(192, 192, 3, stride=2)

    def forward(self, x: Tensor) -> Tensor:
        long = self.branch7x7x3_4(self.branch7x7x3_3(self.branch7x7x3_2(self.branch7x7x3_1(x))))
        return torch.cat([self.branch3x3_2(self.branch3x3_1(x)), long, functional.max_pool2d(x, 3, stride=2)], dim=1)


class _Split(nn.Module):
    """Kernels of 3 pixels, across and down beside each other."""

    def __init__(self, given: int, *, by_maximum: bool) -> None:
        super().__init__()
        self.by_maximum = by_maximum
        self.branch1x1 = _Convolution(given, 320, 1)
        self.branch3x3_1 = _Convolution(given, 384, 1)
        self.branch3x3_2a = _Convolution(384, 384, (1, 3), padding=(0, 1))
        self.branch3x3_2b = _Convolution(384, 384, (3, 1), padding=(1, 0))
        self.branch3x3dbl_1 = _Convolution(given, 448, 1)
        self.branch3x3dbl_2 = _Convolution(448, 384, 3, padding=1)
        self.branch3x3dbl_3a = _Convolution(384, 384, (1, 3), padding=(0, 1))
        self.branch3x3dbl_3b = _Convolution(384, 384, (3, 1), padding=(1, 0))
        self.branch_pool = _Convolution(given, 192, 1)

    def forward(self, x: Tensor) -> Tensor:
        single = self.branch3x3_1(x)
        double = self.branch3x3dbl_2(self.branch3x3dbl_1(x))
        pooled = functional.max_pool2d(x, 3, stride=1, padding=1) if self.by_maximum else _average(x)
        branches = [self.branch1x1(x), self.branch3x3_2a(single), self.branch3x3_2b(single)]
        branches += [self.branch3x3dbl_3a(double), self.branch3x3dbl_3b(double), self.branch_pool(pooled)]
        return torch.cat(branches, dim=1)
