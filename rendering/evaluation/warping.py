"""Frames by warping the whole picture along the flow, with what is left by it filled in, each frame by itself.

The straightforward way that the paper compares its rendering with (Section 4, "Sketch-Guided Rendering").
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.motion import FlowSequence, Motion
from ..pictures import as_uint8
from ..sketch import forward_warp

__all__ = ["warped_and_filled"]

Picture = NDArray[np.uint8]

_REST = 0.001  # weight of a pixel at rest beside one that moved by one pixel, as of sketches
_RADIUS = 5.0  # of OpenCV's filling [px]
_LARGEST_RATIO = 1e6


def warped_and_filled(image: Picture, motion: Motion, *, weight: str = "layered") -> Iterator[Picture]:
    """The frames of a motion.

    Args:
        image: RGB, uint8, shape [h, w, 3].
        motion: of bodies in it.
        weight: which pixel shows where several meet: "layered", that of the body in front, or "paper", that which has
            moved further.

    Returns:
        An iterator over RGB pictures, uint8, shape [h, w, 3], one a frame.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion
        >>> from physanimator.physics.scene import Body
        >>> from physanimator.rendering.evaluation.warping import warped_and_filled
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> first, moved = warped_and_filled(picture, motion)
        >>> moved[30, 51].tolist(), moved[30, 10].tolist() != [200, 60, 40]
        ([200, 60, 40], True)
    """
    flows = FlowSequence(motion)
    shown = image.astype(np.float32)
    fixed = _in_front(flows) if weight == "layered" else None
    for field in flows:
        importance = fixed if fixed is not None else _length(field.displacement) + np.float32(_REST)
        warped, coverage = forward_warp(shown, field.displacement, importance)
        holes = (coverage < 0.5).astype(np.uint8)
        frame = as_uint8(np.clip(warped / 255, 0, 1))
        yield cv2.inpaint(frame, holes, _RADIUS, cv2.INPAINT_TELEA) if holes.any() else frame


def _length(flow: NDArray[Any]) -> NDArray[np.float32]:
    return cv2.magnitude(*cv2.split(flow))


def _in_front(flows: FlowSequence) -> NDArray[np.float32]:
    """A weight for each pixel by which what lies in front wins: what rests least, then body after body."""
    from ...physics.motion import layer_order

    order = layer_order(flows.motion.bodies)
    ratio = min(_LARGEST_RATIO, 1e30 ** (1 / (len(order) + 1)))
    rank = np.zeros(len(order) + 1, dtype=np.float64)  # the last is that of what rests: -1
    for place, number in enumerate(order, start=1):
        rank[number] = place
    return (ratio ** (rank - len(order)))[flows.body].astype(np.float32)
