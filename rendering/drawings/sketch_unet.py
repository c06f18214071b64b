"""The U-Net of image-to-image translation (Isola et al., CVPR 2017) as line extractors for anime use it: Anime2Sketch
(Xiang et al., CVPR 2022), under its public weights' names.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import torch
from torch import Tensor, nn

from ..checkpoints import assign, build_without_storage
from .configuration import SketchUNetConfiguration

__all__ = ["SketchUNet"]


class SketchUNet(nn.Module):
    """RGB in 0..1 becomes dark lines, 0, on paper, 1.

    Attributes:
        multiple: width and height must be multiples of this [px].
        least: the smallest width and height [px].
    """

    def __init__(self, config: SketchUNetConfiguration) -> None:
        super().__init__()
        self.config = config
        self.multiple = self.least = 2**config.levels
        channels = config.level_channels
        block: nn.Module | None = None
        for level in range(config.levels - 1, 0, -1):
            block = _Level(channels[level - 1], channels[level], block)
        assert block is not None
        self.model = _Outermost(config.input_nc, channels[0], block, config.output_nc)

    @classmethod
    def from_reference(
        cls,
        config: SketchUNetConfiguration | Mapping[str, Any],
        state_dict: Mapping[str, Any],
        *,
        file: str = "the state dict",
        wanted: str = "weights of a sketch U-Net",
    ) -> SketchUNet:
        """A network with the weights of a state dict, whose names are the public checkpoint's.

        Args:
            config: sizes; the width is always read off the first convolution.
            state_dict: tensors or arrays by name.
            file: where they come from, for messages.
            wanted: which file this should be, for messages.

        Raises:
            CheckpointError: a name is missing, too many, or its tensor has another shape.
        """
        tensors = {name: torch.as_tensor(value) for name, value in state_dict.items()}
        sizes, first = SketchUNetConfiguration.of(config), tensors.get("model.model.0.weight")
        if first is not None and first.ndim == 4:
            sizes = replace(sizes, base_channels=len(first))
        network = build_without_storage(lambda: cls(sizes))
        assign(network, tensors, file=file, wanted=wanted)
        return network

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
