"""Parts of the See-through nodes (``SEETHROUGH_PARTS``): one illustration cut into painted-in parts with depth.

Source: the ComfyUI node pack of See-through (SIGGRAPH 2026).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...physics.arrays import as_array
from ...physics.errors import InvalidInputError, require, shown
from .artwork import ArtLayer, Artwork
from .limits import MAX_OFFSET, MemoryCount, check_canvas
from .png_layers import trimmed

__all__ = ["from_see_through"]


def from_see_through(parts: Any) -> Artwork:
    """See-through's parts as artwork, the part with the largest depth at the back.

    Args:
        parts: ``{"frame_size": (h, w), "tag2pinfo": {tag: {"img": uint8 [h, w, 4], "xyxy": [x1, y1, x2, y2],
            "depth_median": number}}}``.

    Raises:
        InvalidInputError: it is no such dictionary, or a value is out of range.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import from_see_through
        >>> white = np.full((4, 4, 4), 255, np.uint8)
        >>> parts = {
        ...     "face": {"img": white, "xyxy": [1, 1, 5, 5], "depth_median": 0.4},
        ...     "back hair": {"img": white, "xyxy": [0, 0, 4, 4], "depth_median": 0.6},
        ... }
        >>> from_see_through({"frame_size": (8, 8), "tag2pinfo": parts}).names
        ('back hair', 'face')
    """
    if not isinstance(parts, dict) or not isinstance(parts.get("tag2pinfo"), dict):
        raise InvalidInputError(f"parts must be those of See-through's nodes. Got: {shown(parts)}")
    size = parts.get("frame_size")
    right = isinstance(size, list | tuple) and len(size) == 2 and all(_is_number(each) for each in size)
    require("parts: frame_size", size, right, "a height and a width [px]")
    height, width = int(size[0]), int(size[1])  # type: ignore[index]
    check_canvas(width, height, "parts: frame_size")
    count = MemoryCount("parts")
    layers = []
    for tag, part in parts["tag2pinfo"].items():
        layer = _layer(str(tag), part)
        count.add(layer.pixels.nbytes)
        layers.append(layer)
    layers.sort(key=lambda layer: -(layer.depth or 0.0))
    return Artwork(width, height, tuple(layers))


def _layer(tag: str, part: Any) -> ArtLayer:
    if not isinstance(part, dict):
        raise InvalidInputError(f"part {tag} must be a dictionary. Got: {shown(part)}")
    pixels = as_array(part.get("img"), f"part {tag}")
    if pixels.dtype != np.uint8 or pixels.ndim != 3 or pixels.shape[2] != 4:
        raise InvalidInputError(f"part {tag} must be uint8 of shape [h, w, 4]. Got: {pixels.dtype} {pixels.shape}")
    box = part.get("xyxy", (0, 0))
    corner = [int(each) for each in list(box)[:2] if _is_number(each)] if hasattr(box, "__len__") else []
    require(f"part {tag}: xyxy", shown(box), len(corner) == 2, f"numbers of at most {MAX_OFFSET}")
    depth = part.get("depth_median")
    require(f"part {tag}: depth_median", depth, depth is None or _is_number(depth), "a number")
    return trimmed(ArtLayer(tag, pixels, left=corner[0], top=corner[1], depth=None if depth is None else float(depth)))


def _is_number(value: Any) -> bool:
    number = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    return number and bool(abs(value) <= MAX_OFFSET)
