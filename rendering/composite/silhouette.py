"""The silhouette of a picture with transparency, continued behind a part that is taken away."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import window_around
from ..plate import continue_lines

__all__ = ["ALL", "continued_silhouette", "thrice"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

ALL = np.float32(1e-4)
"""A share as near to 1 as this is 1: what is left could not be told from rounding."""

# Alpha on the silhouette itself.
_HALF = 0.5

# Measured on holes of 14 and 30 px in the silhouettes of discs, waves, boxes and ramps (mean error of alpha 0.019):
# half and twice _AROUND and _LARGEST_BEND change nothing, _ROUNDINGS changes it by a tenth; half of _ROUNDNESS doubles
# it, twice takes off a seventh.

# A guessed silhouette is looked at with this much around it [px].
_AROUND = 60
# It is rounded by a blur as wide as the hole is deep over the first of these, up to the second [px], so many times.
_ROUNDNESS = 5.0
_LARGEST_BEND = 12.0
_ROUNDINGS = 12


def continued_silhouette(opacity: FloatImage, hole: Mask) -> FloatImage:
    """Alpha in a hole, shape [h, w]: silhouettes that enter and leave it go on, else that of the nearest pixel.

    Where the picture is transparent, so is what is behind it. The edge is rounded where it bends more sharply than a
    part behind would, and one pixel wide.
    """
    continued, window = opacity.copy(), window_around(hole, margin=_AROUND)
    around, inside = opacity[window], hole[window]
    lined, lines = continue_lines(thrice(around), inside)
    transparent = around < _HALF
    opaque, known = (lined[..., 0] >= _HALF) & ~transparent, ~inside | lines | transparent
    solid, clear = known & opaque, known & ~opaque
    if not (solid.any() and clear.any()):
        continued[hole] = np.minimum(continued[hole], solid.any())
        return continued
    to_solid, to_clear = (
        cv2.distanceTransform((~each).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE) for each in (solid, clear)
    )
    bend = float(np.clip(np.minimum(to_solid, to_clear).max() / _ROUNDNESS, 1, _LARGEST_BEND))
    shape = _rounded((to_solid < to_clear).astype(np.float32), known, bend)
    slope = np.float32(np.sqrt(2 * np.pi))
    soft = np.clip(_HALF + (cv2.GaussianBlur(shape, (0, 0), 1.0) - _HALF) * slope, 0, 1)
    continued[window] = np.where(inside, np.minimum(np.where(soft > 1 - ALL, np.float32(1), soft), around), around)
    return continued


def _rounded(shape: FloatImage, known: Mask, bend: float) -> FloatImage:
    """A shape with its edge shortened where it is unknown, the faster the more it bends.

    Source: Merriman, Bence and Osher, "Diffusion Generated Motion by Mean Curvature" (1992).
    """
    for _ in range(_ROUNDINGS):
        blurred = cv2.GaussianBlur(shape, (0, 0), bend)
        shape = np.where(known, shape, (blurred > _HALF).astype(np.float32))
    return shape


def thrice(plane: FloatImage) -> FloatImage:
    """A plane, shape [h, w], as a picture of three equal channels."""
    return np.repeat(plane[..., None], 3, axis=2)
