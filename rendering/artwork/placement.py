"""Layers that are placed: mirrored, scaled and turned."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import cv2
import numpy as np

from ..pictures import straight
from .artwork import ArtLayer
from .blending import planes_of
from .flattening import as_whole_numbers

__all__ = ["Placement", "placed"]


@dataclass(frozen=True)
class Placement:
    """Where a picture goes.

    Attributes:
        left: of the picture before it is turned [px].
        top: the same.
        width: that it is scaled to [px].
        height: the same.
        angle: that it is turned by around its middle, clockwise [rad].
        flipped: whether left and right are exchanged, before all else.
        upside_down: whether top and bottom are.
    """

    left: int
    top: int
    width: int
    height: int
    angle: float = 0.0
    flipped: bool = False
    upside_down: bool = False

    @property
    def box(self) -> tuple[int, int, int, int]:
        """Left, top, right and bottom around the picture as it lies [px]."""
        cosine, sine = math.cos(self.angle), math.sin(self.angle)
        half_width = (abs(self.width * cosine) + abs(self.height * sine)) / 2
        half_height = (abs(self.width * sine) + abs(self.height * cosine)) / 2
        x, y = self.left + self.width / 2, self.top + self.height / 2
        slack = 1e-6
        return (
            math.floor(x - half_width + slack),
            math.floor(y - half_height + slack),
            math.ceil(x + half_width - slack),
            math.ceil(y + half_height - slack),
        )


def placed(layer: ArtLayer, placement: Placement) -> ArtLayer:
    """A layer as it lies; its pixels are resampled only where they are scaled or turned."""
    pixels = layer.pixels
    pixels = pixels[:, ::-1] if placement.flipped else pixels
    pixels = pixels[::-1] if placement.upside_down else pixels
    height, width = pixels.shape[:2]
    if (placement.width, placement.height) == (width, height) and placement.angle == 0:
        return replace(layer, pixels=np.ascontiguousarray(pixels), left=placement.left, top=placement.top)
    planes = planes_of(pixels)
    if (placement.width, placement.height) != (width, height):
        shrunk = placement.width * placement.height < width * height
        method = cv2.INTER_AREA if shrunk else cv2.INTER_LINEAR
        planes = cv2.resize(planes, (placement.width, placement.height), interpolation=method)
    left, top, right, bottom = placement.box
    if placement.angle != 0:
        planes = cv2.warpAffine(planes, _turn(placement), (right - left, bottom - top), flags=cv2.INTER_LINEAR)
    return replace(layer, pixels=as_whole_numbers(straight(planes), layer.pixels.dtype), left=left, top=top)


def _turn(placement: Placement) -> np.ndarray:
    """From pixels of the scaled picture to pixels of the box around the turned one, both counted from pixel centres."""
    cosine, sine = math.cos(placement.angle), math.sin(placement.angle)
    left, top, _, _ = placement.box
    x, y = placement.width / 2 - 0.5, placement.height / 2 - 0.5
    to_x, to_y = placement.left + placement.width / 2 - 0.5 - left, placement.top + placement.height / 2 - 0.5 - top
    return np.array([[cosine, -sine, to_x - cosine * x + sine * y], [sine, cosine, to_y - sine * x - cosine * y]])
