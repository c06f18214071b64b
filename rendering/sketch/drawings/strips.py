"""Informative drawings of large pictures, a strip of rows at a time, with the same result as all at once.

Instance normalisation asks for the mean and the variance of a whole picture. Tiles that each used their own would
differ in tone, so every layer's statistics are first gathered over all strips, and the strips are then drawn with
those. What is at full and at half the size is computed anew each time it is needed (about a third more work); only
what is at a quarter of the size is kept.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import Protocol

import torch
from torch import Tensor, nn
from torch.nn import functional

from .informative_drawings import InformativeDrawings

__all__ = ["draw_in_strips"]

Layer = nn.Conv2d | nn.ConvTranspose2d


def draw_in_strips(network: InformativeDrawings, picture: Tensor, *, rows: int) -> Tensor:
    """What ``network(picture)`` gives, in less memory.

    Args:
        network: to draw with.
        picture: RGB 0..1, shape [1, 3, h, w]; h and w multiples of 4 and at least 8.
        rows: height of a strip; fewer need less memory [px].

    Returns:
        Lines 0, paper 1, shape [1, 1, h, w].
    """

    def stage(below: _Rows, layer: nn.Module, *, reflect: int = 0) -> _Stage:
        assert isinstance(layer, nn.Conv2d | nn.ConvTranspose2d)
        return _Stage(below, layer, reflect=reflect, step=max(1, rows * _height(below, layer) // picture.shape[2]))

    full = stage(_Kept(picture), network.model0[1], reflect=3)
    features = stage(stage(full, network.model1[0]), network.model1[3]).whole()
    for block in network.model2:
        layers = block.get_submodule("conv_block")
        inner = stage(_Kept(features), layers.get_submodule("1"), reflect=1).whole()
        features += stage(_Kept(inner), layers.get_submodule("5"), reflect=1).whole(activated=False)
    full = stage(stage(_Kept(features), network.model3[0]), network.model3[3])
    drawing = torch.cat(list(stage(full, network.model4[1], reflect=3).strips()), dim=2)
    return drawing.sigmoid_() if network.config.sigmoid else drawing


class _Rows(Protocol):
    """Something whose rows can be asked for; ``height`` says how many there are."""

    height: int

    def rows(self, first: int, end: int) -> Tensor: ...


class _Kept:
    """Rows of a tensor in memory, shape [1, c, h, w]."""

    def __init__(self, values: Tensor) -> None:
        self.values, self.height = values, values.shape[2]

    def rows(self, first: int, end: int) -> Tensor:
        return self.values[:, :, first:end]


class _Stage:
    """A convolution, normalised and activated, whose rows are computed when they are asked for."""

    def __init__(self, below: _Rows, layer: Layer, *, reflect: int, step: int) -> None:
        """
        Args:
            below: what the layer convolves.
            layer: a convolution, plain, strided by 2, or transposed with a stride of 2.
            reflect: border that is filled by reflection before it [px].
            step: rows of a strip.
        """
        self.below, self.layer, self.reflect, self.step = below, layer, reflect, step
        self.height = _height(below, layer)

    def rows(self, first: int, end: int) -> Tensor:
        mean, scale = self._statistics
        return self._convolved(first, end).sub_(mean).mul_(scale).relu_()

    def strips(self) -> Iterator[Tensor]:
        """The convolution alone, a strip at a time."""
        for first in range(0, self.height, self.step):
            yield self._convolved(first, min(first + self.step, self.height))

    def whole(self, *, activated: bool = True) -> Tensor:
        """All rows, shape [1, c, h, w]."""
        values = self._gathered()
        mean, scale = _statistics_of(values.split(self.step, dim=2))
        values.sub_(mean).mul_(scale)
        return values.relu_() if activated else values

    def _gathered(self) -> Tensor:
        """The convolution alone, all rows in memory once, shape [1, c, h, w]."""
        first = 0
        for strip in self.strips():
            if not first:
                values = strip.new_empty((*strip.shape[:2], self.height, strip.shape[3]))
            values[:, :, first : first + strip.shape[2]] = strip
            first += strip.shape[2]
        return values

    @cached_property
    def _statistics(self) -> tuple[Tensor, Tensor]:
        return _statistics_of(self.strips())

    def _convolved(self, first: int, end: int) -> Tensor:
        layer = self.layer
        if isinstance(layer, nn.ConvTranspose2d):
            # Row 2 i of the result comes from row i; row 2 i + 1 from the rows i and i + 1.
            start = first // 2
            given = self.below.rows(start, min(end // 2 + 1, self.below.height))
            return layer(given)[:, :, first - 2 * start : end - 2 * start]
        if self.reflect:
            given = functional.pad(self._reflected(first, end), (self.reflect, self.reflect, 0, 0), mode="reflect")
            return layer(given)
        stride = layer.stride[0]
        start, stop = first * stride - 1, (end - 1) * stride + 2
        given = self.below.rows(max(start, 0), min(stop, self.below.height))
        beyond = (0, 0, max(-start, 0), max(stop - self.below.height, 0))
        given = functional.pad(given, beyond)
        return functional.conv2d(given, layer.weight, layer.bias, stride, (0, 1))

    def _reflected(self, first: int, end: int) -> Tensor:
        """Rows with a border of ``reflect`` rows above and below, reflected at the picture's border."""
        wanted = torch.arange(first - self.reflect, end + self.reflect)
        last = self.below.height - 1
        wanted = last - (last - wanted.abs()).abs()
        start, stop = int(wanted.min()), int(wanted.max()) + 1
        given = self.below.rows(start, stop)
        return given[:, :, (wanted - start).to(given.device)]


def _statistics_of(strips: Iterable[Tensor]) -> tuple[Tensor, Tensor]:
    """Mean, and one over the standard deviation, of each channel over the whole picture, shape [1, c, 1, 1].

    Means and squares of the strips are put together in double precision (Chan, Golub and LeVeque, 1979).
    """
    count, mean, squares = 0, torch.zeros(()), torch.zeros(())
    for strip in strips:
        variance, here = (x.double() for x in torch.var_mean(strip.float(), dim=(2, 3), correction=0, keepdim=True))
        added = strip.shape[2] * strip.shape[3]
        if not count:
            mean, squares = torch.zeros_like(here), torch.zeros_like(here)
        away = here - mean
        squares = squares + variance * added + away * away * (count * added / (count + added))
        mean = mean + away * (added / (count + added))
        count += added
    scale = (squares / count + _EPSILON).rsqrt()
    return mean.to(strip.dtype), scale.to(strip.dtype)


_EPSILON = 1e-5
"""Of instance normalisation."""


def _height(below: _Rows, layer: nn.Module) -> int:
    """Rows that a layer gives."""
    if isinstance(layer, nn.ConvTranspose2d):
        return 2 * below.height
    assert isinstance(layer, nn.Conv2d)
    return below.height // layer.stride[0]
