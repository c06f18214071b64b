"""Between a picture's pixels and the square that a network sees: colours, coordinates and masks, both ways.

Coordinates of pictures count from their border, so that pixel centres are at integer + 0.5. The networks take the
indices of pixels and add the half themselves.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import ArrayLike, NDArray
from torch import Tensor
from torch.nn import functional

from ...pictures import as_float
from .families import Family

__all__ = ["Square"]


@dataclass(frozen=True)
class Square:
    """How a picture lies in a network's square.

    Attributes:
        width: of the picture [px].
        height: of the picture [px].
        side: of the square [px].
        stretched: whether the picture fills the square; else it keeps its proportions in the upper left corner.
    """

    width: int
    height: int
    side: int
    stretched: bool

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture within the square [px]."""
        if self.stretched:
            return self.side, self.side
        scale = self.side / max(self.width, self.height)
        return max(1, int(self.width * scale + 0.5)), max(1, int(self.height * scale + 0.5))

    def pixels(self, image: NDArray[np.uint8], family: Family) -> Tensor:
        """The network's input.

        Args:
            image: RGB, shape [h, w, 3].
            family: whose colours are wanted.

        Returns:
            float32, shape [1, 3, side, side].
        """
        from PIL import Image

        small = np.asarray(Image.fromarray(image).resize(self.size, Image.Resampling.BILINEAR))
        colours = torch.from_numpy(as_float(small)).permute(2, 0, 1)
        mean, std = (torch.tensor(values).view(3, 1, 1) for values in (family.mean, family.std))
        columns, rows = self.size
        # Zero after the colours are evened: what lies beyond the picture is of the mean colour.
        return functional.pad((colours - mean) / std, (0, self.side - columns, 0, self.side - rows))[None]

    def coordinates(self, points: ArrayLike) -> Tensor:
        """Points of the picture as the network counts them.

        Args:
            points: x and y [px], shape [..., 2].

        Returns:
            x and y [indices of pixels], float32, shape [..., 2].
        """
        scale = np.array(self.size) / (self.width, self.height)
        return torch.from_numpy((np.asarray(points, np.float64) * scale - 0.5).astype(np.float32))

    def logits(self, low: Tensor) -> NDArray[np.float32]:
        """A network's answer over the picture.

        Args:
            low: logits over the square, shape [n, s, s].

        Returns:
            logits, shape [n, h, w].
        """
        columns, rows = self.size
        whole: Any = low.float()[None]
        if not self.stretched:
            whole = functional.interpolate(whole, (self.side, self.side), mode="bilinear", align_corners=False)
            whole = whole[..., :rows, :columns]
        whole = functional.interpolate(whole, (self.height, self.width), mode="bilinear", align_corners=False)
        return whole[0].cpu().numpy()
