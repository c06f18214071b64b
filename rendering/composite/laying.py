"""Laying one layer over what is behind it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ..artwork import Blend

__all__ = ["as_planes", "lay_over"]

FloatImage = NDArray[np.float32]


def lay_over(planes: FloatImage, layer: FloatImage, blend: Blend = "normal") -> None:
    """Lay a layer over planes, in place.

    Args:
        planes: RGB, or premultiplied RGBA, in 0 to 1, shape [3 or 4, h, w].
        layer: premultiplied RGB and coverage, shape [h, w, 4]; or premultiplied RGBA and coverage, shape [h, w, 5];
            no colour above its alpha. A view of planes is fastest.
        blend: how colours meet; one of five channels knows "normal" alone.
    """
    if blend != "normal":
        _blend(planes, np.clip(layer, 0, 1), blend)
        return
    *colours, alpha = np.moveaxis(layer, 2, 0)
    beneath = 1 - alpha
    for plane, added in zip(planes, [*colours, alpha], strict=False):
        plane *= beneath
        plane += added


def as_planes(layer: FloatImage, *, clean: bool = False) -> FloatImage:
    """A resampled layer, shape [h, w, c], as a view of planes, none with more light than alpha.

    Args:
        layer: premultiplied colours and coverage.
        clean: whether it was resampled so that there is no overshoot.
    """
    planes = np.empty((layer.shape[2], *layer.shape[:2]), dtype=np.float32)
    cv2.split(layer, list(planes))
    if not clean:
        alpha = planes[-1]
        np.clip(alpha, 0, 1, out=alpha)
        # Bicubic resampling overshoots at edges; light that is no colour times alpha would be seen as a fringe.
        for colour in planes[:-1]:
            cv2.min(cv2.max(colour, 0, dst=colour), alpha, dst=colour)
    return np.moveaxis(planes, 0, 2)


def _blend(planes: FloatImage, layer: FloatImage, blend: Blend) -> None:
    from ..artwork import lay_over as blended

    opaque = np.ones((1, *planes.shape[1:]), dtype=np.float32)
    below = np.ascontiguousarray(np.moveaxis(np.concatenate([planes, opaque])[:4], 0, 2))
    blended(below, np.minimum(layer, layer[..., 3:]), blend)
    planes[:] = np.moveaxis(below, 2, 0)[: len(planes)]
