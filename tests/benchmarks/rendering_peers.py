"""Other ways to draw a moved part of a flat picture. Each sees what ours sees: the picture, the mask and the motion.

All of them get the exact motion of the mesh, continued over the part's rim, and soft edges: none loses by a flow that
had to be estimated, or by jagged borders.
"""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
from layered_truth import inverse_displacement, nearest_pixel
from physanimator.physics.mesh import bounding_box
from physanimator.physics.motion import FlowSequence, Motion
from physanimator.rendering.pictures import splat
from physanimator.rendering.sketch import splats_of

__all__ = ["Peers"]

_RIM = 6
_RADIUS = 5
# An outline that a mask cuts off would be smeared into what is filled: holes are this much larger [px].
_GROWN = 1


class Peers:
    """Draws frames of a motion in other ways than ours.

    Attributes:
        methods: each gives frame ``t`` as float32 RGB in 0 to 1, shape [h, w, 3], by its name.
    """

    def __init__(self, picture: np.ndarray, mask: np.ndarray, motion: Motion) -> None:
        self.picture, self.mask, self.motion = picture.astype(np.float32) / np.float32(255), mask, motion
        self._flow = FlowSequence(motion)
        self._part = _grown(mask > 0.02)
        self._soft = cv2.GaussianBlur(self._part.astype(np.float32), (0, 0), 1.0)
        self.methods: dict[str, Callable[[int], np.ndarray]] = {
            "backward_warp": self._backward_warp,
            "forward_warp": self._forward_warp,
            "forward_warp_telea": lambda t: self._forward_filled(t, cv2.INPAINT_TELEA),
            "forward_warp_navier_stokes": lambda t: self._forward_filled(t, cv2.INPAINT_NS),
            "soft_mask_telea": lambda t: self._soft_filled(t, cv2.INPAINT_TELEA),
            "soft_mask_navier_stokes": lambda t: self._soft_filled(t, cv2.INPAINT_NS),
        }

    def _backward_warp(self, t: int) -> np.ndarray:
        """Every pixel looks up where it came from; what the part has left still shows it."""
        colour, alpha = self._looked_up(t)
        return colour * alpha + self.picture * (1 - alpha)

    def _forward_warp(self, t: int) -> np.ndarray:
        """The part's pixels are splatted; what they have left still shows them."""
        colour, alpha = self._splatted(t)
        return colour * alpha + self.picture * (1 - alpha)

    def _forward_filled(self, t: int, method: int) -> np.ndarray:
        """Forward warp, and what the part has left is filled from what surrounds it in this frame."""
        colour, alpha = self._splatted(t)
        return colour * alpha + self._inpainted(alpha, method) * (1 - alpha)

    def _soft_filled(self, t: int, method: int) -> np.ndarray:
        """The part looked up with soft edges over a frame filled and softly blended in (the paper's ablation)."""
        colour, alpha = self._looked_up(t)
        soft = self._soft[..., None]
        beneath = self._inpainted(alpha, method) * soft + self.picture * (1 - soft)
        return colour * alpha + beneath * (1 - alpha)

    def _inpainted(self, alpha: np.ndarray, method: int) -> np.ndarray:
        """What is behind the part in one frame. Colours of the moved part itself must not run into it."""
        return _filled(self.picture, self._part | (_grown(alpha[..., 0] > 0.02)), method)

    def _looked_up(self, t: int) -> tuple[np.ndarray, np.ndarray]:
        """Colour and soft mask of the part, bicubic, shapes [h, w, 3] and [h, w, 1]."""
        height, width = self.mask.shape
        mesh, vertices = self.motion.bodies[0].mesh, self.motion.positions[t].astype(np.float64)
        box = bounding_box(vertices, margin=_RIM + 2).clipped(width, height)
        shift, _, near = inverse_displacement(vertices, mesh.vertices, mesh.triangles, box, _RIM)
        x = shift[0] + np.arange(box.left, box.right, dtype=np.float32)
        y = shift[1] + np.arange(box.top, box.bottom, dtype=np.float32)[:, None]
        source = np.dstack([self.picture, self.mask])
        found = np.clip(cv2.remap(source, x, y, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE), 0, 1)
        whole = np.zeros((height, width, 4), dtype=np.float32)
        whole[box.slices] = np.where(near[..., None], found, 0)
        return whole[..., :3], whole[..., 3:]

    def _splatted(self, t: int) -> tuple[np.ndarray, np.ndarray]:
        """Colour and coverage of the splatted part, shapes [h, w, 3] and [h, w, 1]."""
        moved = self.mask > 0.02
        flow = _extended(self._flow.flow(t).displacement, self._flow.inside, moved)
        pieces = splats_of(self.picture, flow, self.mask, moved)
        weight = (pieces.weight * pieces.area).astype(np.float64)
        *sums, total = splat(
            pieces.x, pieces.y, [*(weight * pieces.values[:, k] for k in range(3)), weight], self.mask.shape
        )
        colour = np.stack(sums, axis=-1) / np.maximum(total, 1e-6)[..., None]
        return colour.astype(np.float32), np.clip(total, 0, 1).astype(np.float32)[..., None]


def _grown(part: np.ndarray) -> np.ndarray:
    return cv2.dilate(part.astype(np.uint8), np.ones((2 * _GROWN + 1,) * 2, np.uint8)) > 0


def _extended(flow: np.ndarray, inside: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """The flow, with that of the nearest pixel where the mesh falls short of the mask."""
    if not (wanted & ~inside).any():
        return flow
    row, column = nearest_pixel(inside)
    return np.where(wanted[..., None], flow[row, column], np.float32(0))


def _filled(frame: np.ndarray, hole: np.ndarray, method: int) -> np.ndarray:
    """A frame inpainted by OpenCV."""
    if not hole.any():
        return frame
    as_bytes = np.rint(np.clip(frame, 0, 1) * 255).astype(np.uint8)
    filled = cv2.inpaint(as_bytes, hole.astype(np.uint8), _RADIUS, method)
    return np.where(hole[..., None], filled.astype(np.float32) / np.float32(255), frame)
