"""The true frames of a layered picture: its moving part deformed at high resolution over what is really behind it.

The figure's sprite is cut in two along the mask. What moves is every pixel of the mask, and the slivers of the figure
that are left between the mask and the background, which are its outline and its soft rim. What is cut off stays where
it is. Both are laid over the true background.

Three things the layers do not know, and there nothing is judged. Nobody drew what is behind the part *within* the
figure (the sleeve under the hair): a bared pixel that lies nearer to the still rest of the figure than to the
background is left out while it is bared; all others show the background. And to whom the drawn line between the part
and the still rest belongs is not said: the figure's pixels next to the mask are left out, where they were and where
they would be had they moved along, unless the part covers them. Nor does anything tell how a part goes on that the
picture's border cuts off, once the motion brings the cut into the picture.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from layered_sample import LayeredSample
from physanimator.physics.mesh import PixelBox, bounding_box, interpolate
from physanimator.physics.motion import Motion

__all__ = ["TrueFrame", "TrueFrames", "inverse_displacement", "nearest_pixel"]

SCALE = 3
# How far the rim of the part may lie outside its mesh [px].
_RIM = 6
# The figure's outline may be this much wider than the mask [px].
_OUTLINE = 4
_BACK_PROJECTIONS = 8


@dataclass(frozen=True, eq=False)
class TrueFrame:
    """One true frame.

    Attributes:
        picture: RGB in 0 to 1, float32, shape [h, w, 3].
        alpha: how much of each pixel the moving part covers, float32, shape [h, w].
        judged: false where the truth is not known, bool, shape [h, w].
        uncovered: pixels that the part covered in the drawing and has left, as far as they are judged, shape [h, w].
    """

    picture: np.ndarray
    alpha: np.ndarray
    judged: np.ndarray
    uncovered: np.ndarray


class TrueFrames:
    """The true frames of a layered picture whose part moves."""

    def __init__(self, sample: LayeredSample, motion: Motion) -> None:
        self.sample, self.motion = sample, motion
        share = moving_share(sample.sprite[..., 3], sample.mask)
        alpha = sample.sprite[..., 3] * share
        still = np.where(share < 1, sample.sprite[..., 3], np.float32(0))[..., None]
        self.behind = sample.sprite[..., :3] * still + sample.background * (1 - still)
        seam = _beside((share > 0.5) & (alpha > 0)) & (share < 1) & (sample.sprite[..., 3] > 0)
        self.unknown = seam | ((alpha > 0) & _nearer_to_figure(sample.sprite[..., 3], share))
        self.rest_alpha = alpha
        layers = sample.sprite[..., :3] * alpha[..., None], alpha, seam.astype(np.float32)
        self._texture = _enlarged(np.dstack(layers))
        mesh = motion.bodies[0].mesh
        self._in_mesh = _deep_inside(mesh.vertices, mesh.triangles, self._texture.shape)

    def frame(self, t: int) -> TrueFrame:
        """The true frame ``t``."""
        height, width = self.rest_alpha.shape
        vertices = self.motion.positions[t].astype(np.float64)
        box = bounding_box(vertices, margin=_RIM + 3).clipped(width, height)
        part = np.zeros((height, width, 6), dtype=np.float32)
        fine = PixelBox(*(SCALE * side for side in (box.left, box.top, box.right, box.bottom)))
        drawn = self._drawn(vertices * SCALE, fine)
        part[box.slices] = cv2.resize(drawn, (box.width, box.height), interpolation=cv2.INTER_AREA)
        np.clip(part, 0, 1, out=part)
        alpha = part[..., 3]
        judged = ~((self.unknown | (part[..., 4] > 0.01)) & (alpha < 0.99)) & (part[..., 5] < 0.01)
        picture = np.clip(part[..., :3] + (1 - alpha[..., None]) * self.behind, 0, 1)
        return TrueFrame(picture, alpha, judged, (self.rest_alpha > 0.5) & (alpha < 0.5) & judged)

    def _drawn(self, vertices: np.ndarray, box: PixelBox) -> np.ndarray:
        """The part at high resolution: premultiplied RGB, alpha, seam, and cut, shape [box height, box width, 6]."""
        mesh = self.motion.bodies[0].mesh
        shift, inside, near = inverse_displacement(vertices, mesh.vertices * SCALE, mesh.triangles, box, _RIM * SCALE)
        x = shift[0] + np.arange(box.left, box.right, dtype=np.float32)
        y = shift[1] + np.arange(box.top, box.bottom, dtype=np.float32)[:, None]
        both = self._texture[..., :4], self._texture[..., 4]
        drawn = np.dstack([cv2.remap(each, x, y, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE) for each in both])
        # The rim beyond the mesh: only what lies beyond it in the drawing too, so that no strand is drawn twice.
        deep = cv2.remap(self._in_mesh, x, y, cv2.INTER_NEAREST, borderMode=cv2.BORDER_REPLICATE) > 0
        beyond = (x < 0) | (y < 0) | (x > self._texture.shape[1] - 1) | (y > self._texture.shape[0] - 1)
        cut = beyond & (drawn[..., 3] > 0)
        drawn[~(inside | (near & ~deep))] = 0
        return np.dstack([drawn, cut.astype(np.float32)])


def inverse_displacement(
    vertices: np.ndarray, rest: np.ndarray, triangles: np.ndarray, box: PixelBox, reach: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where each pixel of a moved mesh comes from.

    Args:
        vertices: moved positions [px], shape [v, 2].
        rest: positions in the drawing [px], shape [v, 2].
        triangles: shape [t, 3].
        box: pixels to look at.
        reach: how far the motion of the nearest pixel of the mesh is taken beyond it [px].

    Returns:
        Displacement to the drawing, float32, shape [2, h, w]; where the mesh is; where it is or is near.
    """
    shift = interpolate(vertices, triangles, rest - vertices, box)
    inside = ~np.isnan(shift[0])
    row, column = nearest_pixel(inside) if inside.any() else np.zeros((2, *inside.shape), dtype=np.int64)
    shift = np.nan_to_num(shift[:, row, column])
    near = cv2.distanceTransform((~inside).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5) <= reach
    return np.ascontiguousarray(shift), inside, near


def moving_share(alpha: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """Share of the figure that moves at each pixel: the mask, and all of the figure's edge around it, shape [h, w]."""
    rest = (alpha > 0) & (mask < 0.5)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * _OUTLINE + 1,) * 2)
    # Beyond the picture's border the figure goes on.
    thick = cv2.erode(rest.astype(np.uint8), disc)
    thick = cv2.dilate(thick, disc) > 0
    rim = _beside(mask >= 0.5) & ~thick & (alpha > 0)
    return np.where(rim, np.float32(1), mask).astype(np.float32)


def _beside(part: np.ndarray) -> np.ndarray:
    """A part and the pixels where an outline of it may be, shape [h, w]."""
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * _OUTLINE + 1,) * 2)
    return cv2.dilate(part.astype(np.uint8), disc) > 0


def _nearer_to_figure(alpha: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Where the still rest of the figure is nearer than the background, shape [h, w]."""
    rest, background = (alpha > 0.5) & (share < 0.5), alpha < 0.5
    if not rest.any():
        return np.zeros(alpha.shape, dtype=bool)
    if not background.any():
        return np.ones(alpha.shape, dtype=bool)
    far = [cv2.distanceTransform((~each).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5) for each in (rest, background)]
    return far[0] < far[1]


def _enlarged(layer: np.ndarray) -> np.ndarray:
    """A layer at high resolution whose mean over each pixel is the layer again, so that what rests is as drawn."""
    height, width = layer.shape[:2]
    large = np.zeros((height * SCALE, width * SCALE, layer.shape[2]), dtype=np.float32)
    missing = layer
    for _ in range(_BACK_PROJECTIONS):
        large += cv2.resize(missing, (width * SCALE, height * SCALE), interpolation=cv2.INTER_CUBIC)
        missing = layer - cv2.resize(large, (width, height), interpolation=cv2.INTER_AREA)
    return large


def _deep_inside(rest: np.ndarray, triangles: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Where a mesh is at high resolution, without its outermost pixels, uint8, shape [h, w]."""
    box = PixelBox(0, 0, shape[1], shape[0])
    inside = ~np.isnan(interpolate(rest * SCALE, triangles, rest, box)[0])
    return cv2.erode(inside.astype(np.uint8), np.ones((5, 5), np.uint8))


def nearest_pixel(where: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Row and column of the nearest true pixel of each, shape [h, w] each."""
    _, labels = cv2.distanceTransformWithLabels(
        (~where).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    rows, columns = np.zeros(int(labels.max()) + 1, np.int64), np.zeros(int(labels.max()) + 1, np.int64)
    row, column = np.nonzero(where)
    rows[labels[where]], columns[labels[where]] = row, column
    return rows[labels], columns[labels]
