"""An illustration taken apart: a clean plate, and over it one textured layer for each moving body.

At rest the layers laid over the plate give the illustration again, for every pixel and whatever the alphas: the
texture of a layer is made as the difference, P = I - (1 - alpha) B, between the picture I with the body and the
picture B beneath it.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.beside import side_by_side
from ...physics.errors import InvalidInputError
from ...physics.mesh import PixelBox, TriangleMesh, triangle_ids
from ..matting import fitting_plate, in_levels, mixed_rim, regular_mask, soft_alpha, with_outline
from ..pictures import window_around
from ..plate import fill_hole, spread_colours
from .apron import ApronedMesh, canvas_of, usual_reach
from .beyond_border import on_canvas
from .layer import Layer
from .still_layers import StillLayer, still_layer

__all__ = ["aproned", "picture_beneath", "take_apart"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Pixels around a body that its faint edge may reach.
_BESIDE = 2
# And those that tell how soft that edge is.
_AROUND = 48


def take_apart(
    picture: FloatImage, masks: Sequence[FloatImage], meshes: Sequence[TriangleMesh | None], *, plate: FloatImage | None
) -> tuple[FloatImage, list[Layer | StillLayer]]:
    """Peel the bodies off a picture, the front one first.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        masks: soft mask of each body, from back to front, shape [h, w] each. Where masks overlap, the pixel shows
            the front body; what the body behind looks like there is continued from its visible part.
        meshes: mesh of each body, from back to front; None for what stands still in front of bodies.
        plate: what is behind all bodies, shape [h, w, 3]; None makes a clean plate.

    Returns:
        The plate, equal to the picture wherever no body is; and a layer for each body, from back to front.
    """
    masks = [regular_mask(picture, mask) for mask in masks]
    supports = list(side_by_side(partial(with_outline, picture), masks))
    rounded = in_levels(picture)
    if plate is None:
        unknown = [each | mixed_rim(mask, each) for mask, each in zip(masks, supports, strict=True)]
        plate = _without(picture, np.logical_or.reduce(unknown))
    layers: list[Layer | StillLayer] = []
    for number in range(len(masks) - 1, -1, -1):
        beneath = picture_beneath(picture, plate, masks, supports, number)
        alpha = _alpha(picture, beneath, masks[number], supports[number])
        layer, picture = _peeled(picture, beneath, alpha, meshes[number], rounded=rounded)
        layers = layers if layer is None else [layer, *layers]
    return picture, layers


def _alpha(picture: FloatImage, beneath: FloatImage, mask: FloatImage, support: Mask) -> FloatImage:
    """The soft alpha of a body, looked for around it only."""
    window = window_around(support, margin=_AROUND)
    alpha = np.zeros(mask.shape, dtype=np.float32)
    alpha[window] = soft_alpha(picture[window], beneath[window], mask[window], support[window])
    return alpha


def _peeled(
    picture: FloatImage, beneath: FloatImage, alpha: FloatImage, mesh: TriangleMesh | None, *, rounded: bool
) -> tuple[Layer | StillLayer | None, FloatImage]:
    """The layer of one body or still part, and the picture without it."""
    if mesh is None:
        below = fitting_plate(picture, beneath, alpha, rounded=rounded)
        return still_layer(np.dstack([picture - (1 - alpha[..., None]) * below, alpha])), below
    wider, canvas, covered = aproned(mesh, alpha)
    alpha = np.where(covered, alpha, np.float32(0))
    window, below, layer = _seen(canvas, mesh), picture.copy(), np.zeros((*alpha.shape, 4), dtype=np.float32)
    shown, share = picture[window], alpha[window]
    below[window] = fitting_plate(shown, beneath[window], share, rounded=rounded)
    layer[window] = np.dstack([shown - (1 - share[..., None]) * below[window], share])
    return Layer(wider, canvas, on_canvas(layer, canvas)), below


def _seen(canvas: PixelBox, mesh: TriangleMesh) -> tuple[slice, slice]:
    """Rows and columns of the picture in a canvas, at least those next to it."""
    ends = ((canvas.top, canvas.bottom, mesh.height), (canvas.left, canvas.right, mesh.width))
    rows, columns = (slice(min(max(start, 0), size - 1), max(min(end, size), 1)) for start, end, size in ends)
    return rows, columns


def _without(picture: FloatImage, hole: Mask) -> FloatImage:
    if hole.all():
        raise InvalidInputError("masks must leave some of the picture as background. Got: they cover all of it")
    return fill_hole(picture, hole) if hole.any() else picture


def picture_beneath(
    picture: FloatImage, plate: FloatImage, masks: Sequence[FloatImage], supports: Sequence[Mask], number: int
) -> FloatImage:
    """The picture without one body: the plate in its place, and the bodies further behind as far as they reach."""
    region = _grown(supports[number], _BESIDE)
    beneath = picture.copy()
    beneath[region] = plate[region]
    for behind in range(number):
        in_front = np.logical_or.reduce(supports[behind + 1 :])
        visible = supports[behind] & ~_grown(in_front, _BESIDE)
        hidden = region & supports[behind]
        if hidden.any() and visible.any():
            share, own = np.maximum(masks[behind][hidden], 0)[:, None], beneath[hidden]
            beneath[hidden] = own + share * (spread_colours(picture, visible, hidden)[hidden] - own)
    return beneath


def aproned(mesh: TriangleMesh, alpha: FloatImage) -> tuple[ApronedMesh, PixelBox, Mask]:
    """The mesh with an apron for an alpha, its canvas, and the picture's pixels that it covers at rest."""
    reach = usual_reach(mesh)
    canvas = canvas_of(mesh, reach=reach)
    wider = ApronedMesh.around(mesh, on_canvas(alpha, canvas), canvas, reach=reach)
    whole = PixelBox(0, 0, mesh.width, mesh.height)
    return wider, canvas, triangle_ids(wider.rest, wider.triangles, whole) >= 0


def _grown(mask: Mask, reach: int) -> Mask:
    return cv2.dilate(mask.astype(np.uint8), np.ones((2 * reach + 1,) * 2, np.uint8)) > 0
