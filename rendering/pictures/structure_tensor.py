"""The structure tensor: which way lines and edges of a picture run (Foerstner and Guelch, 1987)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["StructureTensor", "gradients"]

FloatImage = NDArray[np.float32]
Plane = NDArray[Any]


@dataclass(frozen=True, eq=False)
class StructureTensor:
    """Products of a picture's gradient with itself, summed over its channels and averaged over a window.

    Attributes:
        xx, xy, yy: its components, one shape each.
    """

    xx: Plane
    xy: Plane
    yy: Plane

    @property
    def spread(self) -> Plane:
        """How much more the picture changes across than along: the difference of both eigenvalues."""
        return np.asarray(np.sqrt((self.xx - self.yy) ** 2 + 4 * self.xy * self.xy))

    @property
    def across(self) -> Plane:
        """Angle of the direction across the lines, from the x axis [radians]: that of the larger eigenvalue."""
        return np.asarray(0.5 * np.arctan2(2 * self.xy, self.xx - self.yy))

    @property
    def along(self) -> Plane:
        """Unit vectors along the lines, shape [..., 2]."""
        across = self.across
        return np.stack([-np.sin(across), np.cos(across)], axis=-1)


def gradients(picture: FloatImage) -> tuple[FloatImage, FloatImage]:
    """Change of a picture to the right and down (Scharr) [per px], in its shape.

    Args:
        picture: shape [h, w] or [h, w, c], at most four channels.
    """
    # Scharr's kernel answers 32 to a change of one per pixel.
    right, down = (cv2.Scharr(picture, cv2.CV_32F, *way) / np.float32(32) for way in ((1, 0), (0, 1)))
    return right.reshape(picture.shape), down.reshape(picture.shape)
