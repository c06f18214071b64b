"""A line drawing network as an extractor: pictures of any size in, the same kind of sketch out as without a network."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor
from torch.nn import functional

from ....physics.errors import require
from ...pictures import as_float, as_picture
from .. import cleaned
from .informative_drawings import InformativeDrawings
from .models import LineDrawer
from .strips import draw_in_strips

__all__ = ["LEAST_SIDE", "STRIP_PIXELS", "draw_sketch"]

FloatImage = NDArray[np.float32]

LEAST_SIDE = 16
"""The smallest longer side of a picture that a network looks at [px]."""

STRIP_PIXELS = 2**20
"""Larger pictures are drawn in strips of about a quarter of so many pixels."""


def draw_sketch(
    image: NDArray[Any],
    drawer: LineDrawer,
    *,
    working_size: int = 0,
    threshold: float = 0.06,
    smallest_speck: int = 24,
    strip_pixels: int = STRIP_PIXELS,
) -> FloatImage:
    """Dark lines on white paper, as the network draws them.

    It computes where its weights are and as exactly as they are.

    Args:
        image: RGB, uint8 or float in 0..1, shape [h, w, 3].
        drawer: the network.
        working_size: longer side of the picture that the network looks at [px]; 0 takes the picture as it is. The
            networks were trained on small pictures: at a smaller size they draw fewer and bolder lines.
        threshold: how much darker than the paper a line must be; higher leaves faint lines out.
        smallest_speck: connected lines of fewer pixels are left out [px^2].
        strip_pixels: pictures with more pixels are drawn in strips, which takes a third longer and gives the same.

    Returns:
        sketch, paper 1 and lines towards 0, float32, shape [h, w].

    Raises:
        InvalidInputError: the picture or a parameter is unusable.
    """
    picture = as_float(as_picture(image), exact=False)
    require(
        "working_size", working_size, working_size == 0 or LEAST_SIDE <= working_size <= 16384, "0, or 16 to 16384 px"
    )
    height, width = picture.shape[:2]
    given = _resized(picture, working_size / max(height, width) if working_size else 1.0)
    drawn = _drawn(drawer, given, strip_pixels)
    if drawn.shape != (height, width):
        drawn = cv2.resize(drawn, (width, height), interpolation=cv2.INTER_CUBIC)
    # What a network calls paper is a little grey, and most of a picture is paper.
    paper = max(float(np.median(drawn)), 0.5)
    return cleaned(1 - drawn / np.float32(paper), threshold=threshold, smallest_speck=smallest_speck)


def _resized(picture: FloatImage, factor: float) -> FloatImage:
    if factor == 1:
        return picture
    height, width = (max(1, round(side * factor)) for side in picture.shape[:2])
    return cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA if factor < 1 else cv2.INTER_CUBIC)


@torch.inference_mode()
def _drawn(drawer: LineDrawer, picture: FloatImage, strip_pixels: int) -> FloatImage:
    """The network's drawing, padded to a size that it takes and cut back to the picture's, shape [h, w]."""
    weight = next(drawer.parameters())
    batch = torch.from_numpy(picture).permute(2, 0, 1)[None].to(weight.device, weight.dtype)
    height, width = picture.shape[:2]
    batch = _padded(batch, drawer.multiple, drawer.least)
    if isinstance(drawer, InformativeDrawings) and height * width > strip_pixels:
        drawing = draw_in_strips(drawer, batch, rows=_strip_height(batch.shape[3], strip_pixels))
    else:
        drawing = drawer(batch)
    return drawing[0, 0, :height, :width].float().cpu().numpy()


def _padded(batch: Tensor, multiple: int, least: int) -> Tensor:
    """The border's pixels go on to the right and below until the network takes the size."""
    height, width = batch.shape[2:]
    down, right = (max(least, -(-side // multiple) * multiple) - side for side in (height, width))
    return functional.pad(batch, (0, right, 0, down), mode="replicate") if down or right else batch


def _strip_height(width: int, strip_pixels: int) -> int:
    """Rows, a multiple of 4, of a strip of about a quarter of so many pixels."""
    return max(4, strip_pixels // 4 // width // 4 * 4)
