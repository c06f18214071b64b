"""What stands still in front of something that moves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.mesh import PixelBox
from .laying import as_planes

if TYPE_CHECKING:
    from ..artwork import Blend

__all__ = ["StillLayer", "behind_still", "still_layer"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

_HALF = 0.5


@dataclass(frozen=True, eq=False)
class StillLayer:
    """Pixels that stay where they are.

    Attributes:
        box: the pixels of the picture that the texture covers.
        texture: premultiplied RGB and alpha, float32, shape [box height, box width, 4]; of a picture with transparency
            premultiplied RGBA and coverage, 5 channels.
        blend: how it is laid over what is behind it.
    """

    box: PixelBox
    texture: FloatImage
    blend: Blend = "normal"


def still_layer(texture: FloatImage, blend: Blend = "normal") -> StillLayer | None:
    """The layer of a texture of the picture's size, shape [h, w, 4 or 5], cut to where it shows; None for nothing."""
    left, top, width, height = cv2.boundingRect((np.abs(texture).max(axis=2) > 0).astype(np.uint8))
    if not width:
        return None
    box = PixelBox(left, top, left + width, top + height)
    return StillLayer(box, as_planes(np.ascontiguousarray(texture[box.slices])), blend)


def behind_still(mask: FloatImage, cover: Mask) -> FloatImage:
    """A part's mask that goes on behind what stands still in front of it.

    A hidden pixel belongs to the part if the nearest that is not hidden does, as deep as the part is wide: what crosses
    a strand hides all of its width, and of hair beside a body only the edge is behind the body.

    Args:
        mask: of the part as it is seen, 0 to 1, shape [h, w].
        cover: where something still is in front, shape [h, w].

    Raises:
        InvalidInputError: nothing of the part is seen.
    """
    part = mask > _HALF
    seen = part & ~cover
    if part.any() and not seen.any():
        raise InvalidInputError("in_front must leave some of every moving part in sight. Got: it covers all of one")
    beside = ~cover & ~seen
    if not (seen.any() and cover.any()):
        return mask
    to_part, inner = _distance(seen), _distance(~seen)
    nearer = to_part < _distance(beside) if beside.any() else np.ones(mask.shape, dtype=bool)
    hidden = cover & nearer & (to_part <= 2 * inner.max())
    return np.where(hidden, np.float32(1), np.asarray(mask, dtype=np.float32))


def _distance(mask: Mask) -> FloatImage:
    """How far each pixel is from a mask [px], shape [h, w]."""
    return cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
