"""An illustration taken apart: a clean plate, and over it one textured layer for each moving body.

At rest the layers laid over the plate give the illustration again, for every pixel and whatever the alphas: the
texture of a layer is made as the difference, P = I - (1 - alpha) B, between the picture I with the body and the
picture B beneath it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.mesh import PixelBox, TriangleMesh, bounding_box, triangle_ids
from ..matting import fitting_plate, in_levels, mixed_rim, regular_mask, soft_alpha, with_outline
from ..plate import fill_hole, spread_colours
from .apron import ApronedMesh, canvas_of, usual_reach
from .beyond import Beyond
from .beyond_border import on_canvas
from .half_pixels import with_half_pixels
from .places import NOWHERE
from .sheet_edges import Slits, tiles_of, torn
from .still_layers import StillLayer, still_layer

if TYPE_CHECKING:
    from ..artwork import Blend

__all__ = ["Layer", "aproned", "picture_beneath", "take_apart"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Along folds a pixel is the mean of so many places across and down.
_FINE = 3
# Pixels around a body that its faint edge may reach.
_BESIDE = 2


@dataclass(frozen=True, eq=False)
class Layer:
    """One body's picture.

    Attributes:
        mesh: the body's mesh with its apron.
        canvas: the pixels that the texture covers; may exceed the picture.
        texture: premultiplied RGB and alpha at rest, float32, shape [canvas height, canvas width, 4]; of a picture with
            transparency premultiplied RGBA and coverage, 5 channels.
        blend: how it is laid over what is behind it.
        beyond: what leads the pixels that the mesh does not reach; None where there are none.
        fine: whether places between the texture's pixels are read from a finer one, which takes four times the memory.
    """

    mesh: ApronedMesh
    canvas: PixelBox
    texture: FloatImage
    blend: Blend = "normal"
    beyond: Beyond | None = None
    fine: bool = False

    def points(self, vertices: NDArray[np.float32]) -> list[NDArray[np.float64]]:
        """Positions of the mesh's vertices and outer corners [px], shape [v + c, 2], and of what is led beyond it."""
        points = [self.mesh.positions(vertices)]
        if self.beyond is not None:
            points.append(self.beyond.positions(vertices - self.mesh.rest[: len(vertices)].astype(np.float32)))
        return points

    def drawn(self, vertices: NDArray[np.float32], width: int, height: int) -> tuple[PixelBox, FloatImage]:
        """The layer with its mesh moved.

        Args:
            vertices: positions of the body's vertices [px], shape [v, 2].
            width: of the picture [px].
            height: of the picture [px].

        Returns:
            The box of the picture that the layer may touch, and the texture's channels there, shape [h, w, 4 or 5].
        """
        points = self.points(vertices)
        box = bounding_box(np.concatenate(points)).clipped(width, height)
        if not (box.width and box.height):
            return box, np.zeros((box.height, box.width, self.texture.shape[2]), dtype=np.float32)
        x, y = self._places_at_rest(points, box)
        drawn = self._read(x, y)
        edges = self._slits.open(points[0] - self.mesh.rest, points[0], box)
        if self.fine:
            edges |= torn(x, y)
        for tile in tiles_of(edges):
            self._smooth(drawn, points, box, tile, edges)
        return box, drawn

    @cached_property
    def _slits(self) -> Slits:
        return Slits.of(self.mesh.rest, self.mesh.triangles)

    def _read(self, x: FloatImage, y: FloatImage) -> FloatImage:
        """The texture at places of it, shape [h, w, c]."""
        if self.fine:
            texture, border = self._finer
            x, y = 2 * (x + border), 2 * (y + border)
            return cv2.remap(texture, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=0)  # type: ignore[return-value]
        parts = [
            cv2.remap(part, x, y, cv2.INTER_CUBIC, borderMode=cv2.BORDER_CONSTANT, borderValue=0)
            for part in self._parts
        ]
        return parts[0] if len(parts) == 1 else np.dstack(parts)  # type: ignore[return-value]

    def _smooth(
        self, drawn: FloatImage, points: Sequence[NDArray[np.float64]], box: PixelBox, tile: PixelBox, edges: Mask
    ) -> None:
        """Draw pixels of a tile of a box as the mean of several places, where an edge of a sheet goes through them."""
        left, top = box.left + tile.left, box.top + tile.top
        sides = (left, top, left + tile.width, top + tile.height)
        x, y = self._places_at_rest(points, PixelBox(*(_FINE * side for side in sides)), scale=_FINE)
        mean = cv2.resize(self._read(x, y), (tile.width, tile.height), interpolation=cv2.INTER_AREA)
        there = edges[tile.slices]
        drawn[tile.slices][there] = mean[there]

    def _places_at_rest(
        self, points: Sequence[NDArray[np.float64]], box: PixelBox, *, scale: int = 1
    ) -> tuple[FloatImage, FloatImage]:
        """Column and row of the texture that each pixel of a box shows, shape [h, w] each."""
        x, y = self.mesh.places_at_rest(points[0], box, self.canvas, scale=scale)
        if self.beyond is not None:
            free = x <= NOWHERE / 2
            others = self.beyond.places_at_rest(points[1], box, self.canvas, scale=scale)
            for place, other in zip((x, y), others, strict=True):
                np.copyto(place, other, where=free)
        return x, y

    @cached_property
    def _finer(self) -> tuple[FloatImage, int]:
        return with_half_pixels(self.texture)

    @cached_property
    def _parts(self) -> list[FloatImage]:
        """The texture in the four channels at most that OpenCV resamples at once."""
        return [np.ascontiguousarray(self.texture[..., k : k + 4]) for k in range(0, self.texture.shape[2], 4)]


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
    supports, rounded = [with_outline(picture, mask) for mask in masks], in_levels(picture)
    if plate is None:
        unknown = [each | mixed_rim(mask, each) for mask, each in zip(masks, supports, strict=True)]
        plate = _without(picture, np.logical_or.reduce(unknown))
    layers: list[Layer | StillLayer] = []
    for number in range(len(masks) - 1, -1, -1):
        beneath = picture_beneath(picture, plate, masks, supports, number)
        alpha = soft_alpha(picture, beneath, masks[number], supports[number])
        layer, picture = _peeled(picture, beneath, alpha, meshes[number], rounded=rounded)
        layers = layers if layer is None else [layer, *layers]
    return picture, layers


def _peeled(
    picture: FloatImage, beneath: FloatImage, alpha: FloatImage, mesh: TriangleMesh | None, *, rounded: bool
) -> tuple[Layer | StillLayer | None, FloatImage]:
    """The layer of one body or still part, and the picture without it."""
    if mesh is None:
        below = fitting_plate(picture, beneath, alpha, rounded=rounded)
        return still_layer(np.dstack([picture - (1 - alpha[..., None]) * below, alpha])), below
    wider, canvas, covered = aproned(mesh, alpha)
    alpha = np.where(covered, alpha, np.float32(0))
    below = fitting_plate(picture, beneath, alpha, rounded=rounded)
    colour = picture - (1 - alpha[..., None]) * below
    return Layer(wider, canvas, on_canvas(np.dstack([colour, alpha]), canvas)), below


def _without(picture: FloatImage, hole: Mask) -> FloatImage:
    if hole.all():
        raise InvalidInputError("masks must leave some of the picture as background. Got: they cover all of it")
    return fill_hole(picture, hole) if hole.any() else picture


def picture_beneath(
    picture: FloatImage, plate: FloatImage, masks: Sequence[FloatImage], supports: Sequence[Mask], number: int
) -> FloatImage:
    """The picture without one body: the plate in its place, and the bodies further behind as far as they reach."""
    region = _grown(supports[number], _BESIDE)
    beneath = np.where(region[..., None], plate, picture)
    for behind in range(number):
        in_front = np.logical_or.reduce(supports[behind + 1 :])
        visible = supports[behind] & ~_grown(in_front, _BESIDE)
        hidden = region & supports[behind]
        if hidden.any() and visible.any():
            share = np.where(hidden, np.maximum(masks[behind], 0), np.float32(0))[..., None]
            beneath = beneath + share * (spread_colours(picture, visible, hidden) - beneath)
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
