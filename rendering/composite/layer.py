"""One body's picture, drawn wherever its mesh has moved."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, bounding_box
from .apron import ApronedMesh
from .beyond import Beyond
from .half_pixels import with_half_pixels
from .laying import as_planes
from .sheet_edges import Slits, drawn_sides, tiles_of, torn
from .sheets import Places, Sheets, pairs_of, sheets_at, sheets_in_tiles

if TYPE_CHECKING:
    from ..artwork import Blend
    from .hidden_areas import HiddenArea

__all__ = ["Layer"]

FloatArray = NDArray[np.float64]
FloatImage = NDArray[np.float32]

# Where an edge of a sheet goes through a pixel, that is the mean of so many places across and down.
_FINE = 3
_TILE = 4
# OpenCV reads at most 32766 rows of places at once, and a tile has twelve.
_AT_ONCE = 2048
# Above this the sheet beneath does not show.
_OPAQUE = 1 - 0.5 / 255


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

    def points(self, vertices: NDArray[np.float32]) -> list[FloatArray]:
        """Positions of the mesh's vertices and outer corners [px], shape [v + c, 2], and of what is led beyond it."""
        points = [self.mesh.positions(vertices)]
        if self.beyond is not None:
            points.append(self.beyond.positions(vertices - self.mesh.rest[: len(vertices)].astype(np.float32)))
        return points

    def drawn(
        self, vertices: NDArray[np.float32], width: int, height: int, *, hidden: HiddenArea | None = None
    ) -> tuple[PixelBox, FloatImage]:
        """The layer with its mesh moved.

        Args:
            vertices: positions of the body's vertices [px], shape [v, 2].
            width: of the picture [px].
            height: of the picture [px].
            hidden: where the layer is not seen, so that anything may be drawn; None for nowhere.

        Returns:
            The box of the picture that the layer may touch, and the texture's channels there, as a view of planes,
            shape [h, w, 4 or 5].
        """
        points = self.points(vertices)
        box = bounding_box(np.concatenate(points)).clipped(width, height)
        if not (box.width and box.height):
            return box, np.zeros((box.height, box.width, self.texture.shape[2]), dtype=np.float32)
        triangles = self.mesh.triangles if hidden is None else hidden.seen(points[0], self.mesh.triangles)
        sheets = self._sheets(points, triangles, partial(sheets_at, box=box, canvas=self.canvas))
        drawn = self._read(sheets)
        sides = self._slits.opened(points[0] - self.mesh.rest)
        simple = not (len(sides) or len(sheets.double))
        if not simple:
            edges = drawn_sides(sides, points[0], box) | torn(sheets)
            for tiles in _at_once(tiles_of(edges, _TILE)):
                self._smooth(drawn, points, box, tiles, edges)
        return box, as_planes(drawn, clean=simple and self.fine)

    def _smooth(
        self,
        drawn: FloatImage,
        points: Sequence[FloatArray],
        box: PixelBox,
        tiles: NDArray[np.int64],
        edges: NDArray[np.bool_],
    ) -> None:
        """Draw pixels of tiles of a box as the mean of several places, where an edge of a sheet goes through them."""
        corners = tiles + (box.left, box.top)
        find = partial(sheets_in_tiles, tiles=corners, canvas=self.canvas, side=_TILE, scale=_FINE)
        fine = self._read(self._sheets(points, self.mesh.triangles, find))
        mean = cv2.resize(fine, (_TILE, _TILE * len(tiles)), interpolation=cv2.INTER_AREA)
        beside = np.arange(_TILE)
        rows = np.repeat(tiles[:, 1:] + beside, _TILE, axis=1).ravel()
        columns = np.tile(tiles[:, :1] + beside, (1, _TILE)).ravel()
        there = np.flatnonzero((rows < box.height) & (columns < box.width))
        there = there[edges[rows[there], columns[there]]]
        drawn[rows[there], columns[there]] = mean.reshape(len(rows), -1)[there]

    def _sheets(
        self, points: Sequence[FloatArray], triangles: NDArray[np.integer], find: Callable[..., Sheets]
    ) -> Sheets:
        """The places of the texture that are shown by triangles of the mesh, and beyond it."""
        sheets = find(points[0], triangles, self.mesh.rest)
        if self.beyond is None:
            return sheets
        other = find(points[1], self.beyond.triangles, self.beyond.rest)
        return replace(sheets, shown=np.where(sheets.covered, sheets.shown, self.beyond.without_own(other.shown)))

    def _read(self, sheets: Sheets) -> FloatImage:
        """The texture at places of it, with what shows through of sheets beneath, shape [h, w, c]."""
        drawn = self._resampled(sheets.shown)
        flat = drawn.reshape(-1, drawn.shape[2])
        through = 1 - np.clip(flat[sheets.double, -1:], 0, 1)
        for shown in _at_once(np.flatnonzero(through > 1 - _OPAQUE)):
            beneath = self._resampled(sheets.beneath[shown, None])[:, 0]
            flat[sheets.double[shown]] += through[shown] * beneath
        return drawn

    def _resampled(self, places: Places) -> FloatImage:
        """The texture at places of it, shape [h, w, c]."""
        how = {"borderMode": cv2.BORDER_CONSTANT, "borderValue": 0}
        if self.fine:
            texture, border = self._finer
            pairs = pairs_of(places) + np.float32(border)
            pairs *= 2
            return cv2.remap(texture, pairs, None, cv2.INTER_LINEAR, **how)
        parts = [cv2.remap(part, pairs_of(places), None, cv2.INTER_CUBIC, **how) for part in self._parts]
        return parts[0] if len(parts) == 1 else np.dstack(parts)

    @cached_property
    def _slits(self) -> Slits:
        return Slits.of(self.mesh.rest, self.mesh.triangles)

    @cached_property
    def _finer(self) -> tuple[FloatImage, int]:
        return with_half_pixels(self.texture)

    @cached_property
    def _parts(self) -> list[FloatImage]:
        """The texture in the four channels at most that OpenCV resamples at once."""
        return [np.ascontiguousarray(self.texture[..., k : k + 4]) for k in range(0, self.texture.shape[2], 4)]


def _at_once(rows: NDArray[np.int64]) -> Iterator[NDArray[np.int64]]:
    """An array in parts of so many rows as can be read at once; none where it is empty."""
    return (rows[start : start + _AT_ONCE] for start in range(0, len(rows), _AT_ONCE))
