"""What a mask probably does not mean: sentences to show as warnings."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..mesh import may_be_inverted

__all__ = ["doubts_about_mask", "mask_advice"]

# A smaller part, and a smaller share of the picture, is rather a slip of the brush than something that bends [px^2].
_TINY, _TINY_SHARE = 64, 0.005
# A picture is grey on more than this share of itself, a mask only along its edges; between these it is grey.
_GREY_SHARE, _BLACK, _WHITE = 0.5, 0.06, 0.94
# A line around something encloses so many times its own area, and is narrower than this share of what it encloses; so
# wide gaps in it are closed, as a share of the longer side.
_ENCLOSED, _NARROW, _GAP = 2.0, 0.15, 0.02
_LOOKED_AT = 512  # longest side at which is looked for lines [px]


def mask_advice(mask: ArrayLike) -> list[str]:
    """Sentences about a mask that probably shows something else than the part that shall move.

    Args:
        mask: coverage 0..1 or bool, shape [h, w].
    """
    coverage = np.asarray(mask, dtype=np.float32)
    found = doubts_about_mask(coverage)
    if not found and coverage.size and may_be_inverted(coverage):
        share = 100 * float((coverage > 0.5).mean())
        found = [f"the mask covers {share:.0f} % of the picture: is it inverted? White is what moves."]
    return found


def doubts_about_mask(mask: ArrayLike) -> list[str]:
    """The same without a word on whether it is inverted, which is also seen from the mesh.

    Args:
        mask: coverage 0..1 or bool, shape [h, w].
    """
    coverage = np.asarray(mask, dtype=np.float32)
    covered = coverage > 0.5
    pixels = int(np.count_nonzero(covered))
    if not pixels:
        return []
    if pixels < _TINY and pixels < _TINY_SHARE * covered.size:
        return [f"the mask covers {pixels} px only: is it the whole part that shall move?"]
    grey = float(((coverage > _BLACK) & (coverage < _WHITE)).mean())
    if grey > _GREY_SHARE:
        return [
            f"the mask is grey on {100 * grey:.0f} % of the picture: is it a mask? White is what moves, black what"
            " stays; what is brighter than half counts as white."
        ]
    if enclosed := _enclosed(covered):
        return [f"the mask is a line around {enclosed} px: fill it with white if what is inside shall move, too."]
    return []


def _enclosed(covered: NDArray[np.bool_]) -> int:
    """The area inside of a mask that is no more than an outline [px^2], 0 where it is more."""
    scale = min(1.0, _LOOKED_AT / max(covered.shape))
    size = tuple(max(1, round(side * scale)) for side in covered.shape[::-1])
    lines = (cv2.resize(covered.astype(np.float32), size, interpolation=cv2.INTER_AREA) > 0.25).astype(np.uint8)
    gap = 2 * max(1, round(_GAP / 2 * max(size))) + 1
    closed = cv2.morphologyEx(np.pad(lines, gap), cv2.MORPH_CLOSE, np.ones((gap, gap), np.uint8))
    outlines, _ = cv2.findContours(closed, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    filled = cv2.drawContours(np.zeros_like(closed), outlines, -1, 1, cv2.FILLED)
    inside = np.count_nonzero(filled & (1 - closed))
    widest = 2 * float(cv2.distanceTransform(np.pad(lines, 1), cv2.DIST_L2, cv2.DIST_MASK_5).max())
    is_line = inside > _ENCLOSED * np.count_nonzero(lines) and widest < _NARROW * float(np.sqrt(inside))
    return round(inside / scale**2) if is_line else 0
