"""Masks as a hasty hand or a network draws them: too large, too small, beside the part, or with a ragged outline."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["MASK_ERRORS", "spoiled"]

FloatImage = NDArray[np.float32]

MASK_ERRORS = ("grown", "shrunk", "shifted", "ragged")
"""How a mask can be wrong."""

_MEANT_FOR = 512.0  # px of a picture's longer side, at which errors have the size that is named
_WAVES = 1.5  # length of an outline's waves, in amplitudes


def spoiled(mask: NDArray[Any], error: str, amount: float, *, seed: int = 0) -> FloatImage:
    """A mask with an error.

    Args:
        mask: 0..1, shape [h, w].
        error: one of ``MASK_ERRORS``.
        amount: how far the outline is off [px of a picture of 512 px].
        seed: of a ragged outline.

    Returns:
        0..1, float32, shape [h, w].

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.evaluation.mask_errors import spoiled
        >>> mask = np.zeros((512, 512), np.float32)
        >>> mask[100:200, 100:200] = 1
        >>> int(spoiled(mask, "grown", 4.0)[150].sum()), int(spoiled(mask, "shrunk", 4.0)[150].sum())
        (108, 92)
    """
    mask = np.asarray(mask, dtype=np.float32)
    far = amount * max(mask.shape) / _MEANT_FOR
    if error == "shifted":
        along = far / np.sqrt(2)
        move = np.array([[1, 0, along], [0, 1, along]], dtype=np.float32)
        return cv2.warpAffine(mask, move, mask.shape[1::-1])
    outward = -_signed_distance(mask)
    reach = {"grown": far, "shrunk": -far}.get(error)
    offset: Any = _waves(mask.shape, far, seed) if reach is None else reach
    return np.clip(offset - outward + 0.5, 0, 1).astype(np.float32)


def _signed_distance(mask: FloatImage) -> FloatImage:
    """How far each pixel is from the outline [px]: inside above 0, outside below."""
    inside = (mask > 0.5).astype(np.uint8)
    within = cv2.distanceTransform(inside, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    beyond = cv2.distanceTransform(1 - inside, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return np.where(inside > 0, within - 0.5, 0.5 - beyond).astype(np.float32)


def _waves(shape: tuple[int, ...], amplitude: float, seed: int) -> FloatImage:
    """Smooth noise over the picture, of a standard deviation."""
    noise = np.random.default_rng(seed).standard_normal(shape[:2]).astype(np.float32)
    smooth = cv2.GaussianBlur(noise, (0, 0), max(0.5, _WAVES * amplitude), borderType=cv2.BORDER_REFLECT)
    return smooth * np.float32(amplitude / max(float(smooth.std()), 1e-9))
