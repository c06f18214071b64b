"""Layered artwork as the renderer draws it: what moves with its own pixels, and what stands still flattened in runs.

Runs of still layers between two moving ones are laid over one another once, and only where something moving ever is.
Pixels of a moving layer that its mesh does not reach, specks and faint glows, go along with the mesh (see ``beyond``).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require
from ...physics.mesh import PixelBox, TriangleMesh, bounding_box, triangle_ids
from ..artwork import ArtLayer, Artwork, laid_together, planes_of
from ..artwork import lay_over as blended
from ..pictures import as_picture, straight
from .apron import ApronedMesh, canvas_of, usual_reach
from .beyond import Beyond
from .layer import Layer
from .laying import lay_over
from .pixel_boxes import around, shared, within
from .still_layers import StillLayer

__all__ = ["ArtworkPieces", "Mover", "bent", "pieces_of", "texture_over"]

FloatImage = NDArray[np.float32]

_OPAQUE = 1 - 0.5 / 255
_BYTES = 16
"""Of a pixel as four floating-point numbers."""

MAX_FINE_PIXELS = 2**24
"""Up to so many pixels of moving layers, these are held at twice their resolution, which is 1 GiB."""

LONGEST_FINE = 16_000
"""Layers with longer sides [px] are not, since OpenCV reads from textures of up to 32,766 pixels a side."""

MAX_HELD_GIB = 6
"""Moving layers and what is between them are refused beyond this, as floating-point numbers in memory [GiB]."""


@dataclass(frozen=True, eq=False)
class Mover:
    """How a layer moves.

    Attributes:
        mesh: its mesh.
        positions: of the mesh's vertices in all frames [px], shape [frames, v, 2].
    """

    mesh: TriangleMesh
    positions: NDArray[np.float32]

    @property
    def farthest(self) -> int:
        """How far a vertex ever goes [px]."""
        return int(np.ceil(np.abs(self.positions - self.mesh.vertices.astype(np.float32)).max(initial=0)))


@dataclass(frozen=True, eq=False)
class ArtworkPieces:
    """What a frame of artwork is laid together of.

    Attributes:
        plate: what stands still, hidden places included, RGB or straight RGBA, uint8 or float32.
        region: the part of the canvas where something that moves ever is.
        background: what is behind all that moves, over the region, in 0 to 1: RGB where it is opaque, shape [h, w, 3],
            else premultiplied RGBA, shape [h, w, 4].
        layers: those over it, from back to front.
        sources: for each of them the index of the layer that moves; None for what stands still.
    """

    plate: NDArray[np.uint8] | FloatImage
    region: PixelBox
    background: FloatImage
    layers: list[Layer | StillLayer]
    sources: list[int | None]


def pieces_of(artwork: Artwork, movers: Mapping[int, Mover]) -> ArtworkPieces:
    """Take an artwork apart.

    Args:
        artwork: the layers; hidden ones are left out unless they move.
        movers: the layers that move, by their index.

    Raises:
        InvalidInputError: it would need too much memory.
    """
    still = [
        layer if index not in movers and layer.visible and layer.opacity > 0 else None
        for index, layer in enumerate(artwork.layers)
    ]
    held = _held(artwork, movers)
    moving = {index: _moving(artwork, index, mover, fine=held <= MAX_FINE_PIXELS) for index, mover in movers.items()}
    region = _region(moving, movers, artwork)
    first = min(movers, default=len(still))
    background = _laid(still[:first], region)
    layers: list[Layer | StillLayer] = []
    sources: list[int | None] = []
    for piece, source in _stacked(still, moving, first, region):
        layers.append(piece)
        sources.append(source)
    whole = (0, 0, artwork.width, artwork.height)
    plate = laid_together([each for each in still if each is not None], whole, artwork.dtype)
    opaque = bool((plate[..., 3] == np.iinfo(plate.dtype).max).all()) and background[..., 3].min(initial=1) >= _OPAQUE
    plate = as_picture(np.ascontiguousarray(plate[..., :3]) if opaque else plate, alpha=True)
    return ArtworkPieces(plate, region, background[..., :3] if opaque else background, layers, sources)


def _stacked(
    still: Sequence[ArtLayer | None], moving: Mapping[int, Layer], first: int, region: PixelBox
) -> Iterable[tuple[Layer | StillLayer, int | None]]:
    """What is over the background, from back to front: runs of normal still layers are one."""
    run: list[ArtLayer] = []
    for index in range(first, len(still)):
        layer = still[index]
        if index not in moving and (layer is None or layer.blend == "normal"):
            run += [] if layer is None else [layer]
            continue
        if run:
            yield from ((each, None) for each in _flattened_run(run, region))
            run = []
        if index in moving:
            yield moving[index], index
        elif layer is not None:
            yield from ((each, None) for each in _flattened_run([layer], region))
    if run:
        yield from ((each, None) for each in _flattened_run(run, region))


def _flattened_run(run: Sequence[ArtLayer], region: PixelBox) -> list[StillLayer]:
    """Layers laid over one another as one that stands still, cut to where they show; none where nothing does."""
    boxes = [shared(PixelBox(*layer.box), region) for layer in run]
    boxes = [box for box in boxes if box.width and box.height]
    if not boxes:
        return []
    box = around(boxes)
    # One layer keeps its own mode; several are normal.
    texture = texture_over(run[0], box) if len(run) == 1 else _laid(run, box)
    left, top, width, height = cv2.boundingRect((texture[..., 3] > 0).astype(np.uint8))
    if not width:
        return []
    planes = np.ascontiguousarray(np.moveaxis(texture[top : top + height, left : left + width], 2, 0))
    inner = PixelBox(box.left + left, box.top + top, box.left + left + width, box.top + top + height)
    return [StillLayer(inner, np.moveaxis(planes, 0, 2), run[0].blend)]


def _laid(layers: Iterable[ArtLayer | None], box: PixelBox) -> FloatImage:
    """Layers laid over one another in a box of the canvas, premultiplied RGBA, shape [h, w, 4]."""
    planes = np.zeros((box.height, box.width, 4), dtype=np.float32)
    for layer in layers:
        part = PixelBox(0, 0, 0, 0) if layer is None else shared(PixelBox(*layer.box), box)
        if layer is not None and part.width and part.height:
            blended(planes[within(part, box).slices], texture_over(layer, part), layer.blend)
    return planes


def bent(layer: ArtLayer, pieces: Sequence[tuple[PixelBox, FloatImage]]) -> ArtLayer:
    """A layer as it is in one frame, of pieces laid over one another, cut to where it shows.

    Args:
        layer: at rest.
        pieces: boxes of the canvas and premultiplied RGBA there, from back to front; a fifth channel is left out.
    """
    whole = around([box for box, _ in pieces])
    planes = np.zeros((4, whole.height, whole.width), dtype=np.float32)
    for box, texture in pieces:
        rows, columns = within(box, whole).slices
        lay_over(planes[:, rows, columns], texture[..., :4])
    left, top, across, down = cv2.boundingRect((planes[3] > 0).astype(np.uint8))
    shown = straight(np.ascontiguousarray(np.moveaxis(planes, 0, 2)[top : top + down, left : left + across]))
    kind = layer.pixels.dtype
    pixels = np.rint(shown * np.float32(np.iinfo(kind).max)).astype(kind)
    return replace(layer, pixels=pixels, left=whole.left + left, top=whole.top + top, opacity=1.0, visible=True)


def texture_over(layer: ArtLayer, box: PixelBox) -> FloatImage:
    """Premultiplied RGBA of a layer over a box of the canvas, with its opacity, shape [box height, box width, 4]."""
    texture = np.zeros((box.height, box.width, 4), dtype=np.float32)
    own = PixelBox(*layer.box)
    there = shared(own, box)
    if there.width and there.height:
        texture[within(there, box).slices] = planes_of(layer.pixels[within(there, own).slices], layer.opacity)
    return texture


def _moving(artwork: Artwork, index: int, mover: Mover, *, fine: bool) -> Layer:
    """A layer on its mesh, and what of it the mesh does not reach led by the mesh."""
    layer, mesh = artwork.layers[index], mover.mesh
    reach = usual_reach(mesh)
    wide = canvas_of(mesh, reach=reach)
    wider = ApronedMesh.around(mesh, texture_over(layer, wide)[..., 3], wide, reach=reach)
    box = _kept(artwork, layer, mover)
    texture = texture_over(layer, box)
    covered = triangle_ids(wider.rest, wider.triangles, box) >= 0
    beyond = Beyond.of(mesh, (texture[..., 3] > 0) & ~covered, covered, box)
    return Layer(wider, box, texture, layer.blend, beyond, fine and max(box.width, box.height) <= LONGEST_FINE)


def _kept(artwork: Artwork, layer: ArtLayer, mover: Mover) -> PixelBox:
    """The box of the canvas that holds what of a moving layer may ever be seen; at least one pixel."""
    far = mover.farthest + 2
    box = shared(PixelBox(*layer.box), PixelBox(-far, -far, artwork.width + far, artwork.height + far))
    return box if box.width and box.height else PixelBox(0, 0, 1, 1)


def _region(moving: Mapping[int, Layer], movers: Mapping[int, Mover], artwork: Artwork) -> PixelBox:
    """Where layers that move ever are, at rest included."""
    boxes = [
        bounding_box(np.concatenate(layer.points(vertices)))
        for index, layer in moving.items()
        for vertices in (movers[index].mesh.vertices.astype(np.float32), *movers[index].positions)
    ]
    return around(boxes).clipped(artwork.width, artwork.height)


def _held(artwork: Artwork, movers: Mapping[int, Mover]) -> int:
    """Pixels of the layers that move.

    Raises:
        InvalidInputError: they need too much memory.
    """
    boxes = [_kept(artwork, artwork.layers[index], mover) for index, mover in movers.items()]
    pixels = sum(box.width * box.height for box in boxes)
    needed = _BYTES * (pixels + artwork.width * artwork.height) / 2**30
    require(
        "artwork",
        f"{needed:.1f} GiB",
        needed <= MAX_HELD_GIB,
        f"small enough that its {len(movers)} moving layers need at most {MAX_HELD_GIB} GiB; scale it down, or let"
        " fewer layers move",
    )
    return pixels
