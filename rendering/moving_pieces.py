"""What a renderer draws, as the pieces and meshes of a puppet that other programs move."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from ..physics.errors import InvalidInputError, require
from ..physics.mesh import PixelBox
from .composite import Layer, LayeredRenderer, PixelArtRenderer
from .export import MovingMesh, Puppet, PuppetPiece
from .layer_pictures import MARGIN, LayerPicture, layer_pictures
from .pictures import bled, resized

if TYPE_CHECKING:
    from .artwork import ArtLayer, Blend

__all__ = ["DEFAULT_TOLERANCE", "check_tolerance", "puppet_of"]

DEFAULT_TOLERANCE = 0.25
"""How far vertices may be from where the motion has them, when nothing is said [px]: nobody sees that."""

_LONGEST = 8192  # px on a side of a picture, as graphics cards take it
_MOST_PIXELS = 2**27
_MARGIN = 2  # px of transparency around what bends, so that its edge is as soft as it was drawn
_LARGEST_TOLERANCE = 10.0


def check_tolerance(tolerance: float) -> None:
    """Refuse a tolerance for pieces that are moved by other programs; InvalidInputError."""
    require("tolerance", tolerance, 0.01 <= tolerance <= _LARGEST_TOLERANCE, f"0.01 to {_LARGEST_TOLERANCE:g} px")


def puppet_of(
    renderer: LayeredRenderer | PixelArtRenderer,
    *,
    first: int = 0,
    blends: Sequence[Blend] = ("normal", "multiply", "screen", "add"),
) -> Puppet:
    """The pieces that a renderer lays over one another, and their meshes in every frame.

    Args:
        renderer: what draws the frames.
        first: number of the motion's first frame that is shown.
        blends: modes that the other program knows. A still layer of another one gets the colours that it gives where
            nothing has moved, a moving one is laid over what is behind it.

    Raises:
        InvalidInputError: it draws pixel art.
    """
    if isinstance(renderer, PixelArtRenderer):
        raise InvalidInputError("a motion for other programs must be without pixel_art. Got: pixel art")
    motion, artwork, movers = renderer.motion, renderer.layers_at_rest, renderer.movers
    stills = layer_pictures(artwork, list(movers), most_pixels=_MOST_PIXELS, longest=_LONGEST, blends=blends)
    by_layer = {picture.layer: picture for picture in stills}
    pieces = []
    for index, (name, layer) in enumerate(zip(artwork.names, artwork.layers, strict=True)):
        if index in movers:
            piece, body = movers[index]
            blend: Blend = layer.blend if layer.blend in blends else "normal"
            pieces.append(_moving(name, layer, piece, motion.of_body(body)[first:], blend))
        elif index in by_layer:
            pieces.append(_still(name, by_layer[index]))
    shown = len(motion) - first
    loops = motion.loop is not None and shown % motion.loop.frames == 0
    return Puppet(motion.width, motion.height, motion.frame_rate, shown, loops, tuple(pieces))


class _Part(NamedTuple):
    """A part of a piece's mesh: vertices at rest, triangles, and where the vertices are in the piece's picture [px]."""

    rest: NDArray[np.float64]
    triangles: NDArray[np.int64]
    places: NDArray[np.float64]


def _still(name: str, picture: LayerPicture) -> PuppetPiece:
    left, top, width, height = picture.box
    pixels, margin = picture.pixels, 0
    if pixels.shape[:2] == (height, width):  # at its own resolution
        margin = MARGIN
        pixels = pixels[margin:-margin, margin:-margin]
    box = (left + margin, top + margin, width - 2 * margin, height - 2 * margin)
    return PuppetPiece(name, bled(np.ascontiguousarray(pixels)), box, picture.blend)


def _moving(name: str, layer: ArtLayer, piece: Layer, positions: NDArray[np.float32], blend: Blend) -> PuppetPiece:
    """A layer on its mesh. Specks that squares beyond the mesh carry are below it in the same picture."""
    whole = _within(layer, piece.canvas)
    shown, corner = _trimmed(whole, piece.canvas)
    parts = [_Part(piece.mesh.rest, piece.mesh.triangles, piece.mesh.rest - corner)]
    if piece.beyond is not None:
        # Up to the mesh's edge, from which the renderer's mask keeps away: drawn twice, what is see-through has a rim.
        own = cv2.dilate(piece.beyond.own.astype(np.uint8), np.ones((5, 5), np.uint8)) > 0
        whole[own] = 0
        specks, speck_corner = _trimmed(whole, piece.canvas)
        below = piece.beyond.rest - speck_corner + (0, shown.shape[0])
        parts.insert(0, _Part(piece.beyond.rest, piece.beyond.triangles, below))
        shown = _below_one_another(shown, specks)
    size = np.array(shown.shape[1::-1], dtype=np.float64)
    starts = np.cumsum([0, *(len(part.rest) for part in parts)])
    triangles = np.concatenate([part.triangles + start for part, start in zip(parts, starts, strict=False)])
    rest, places = (np.concatenate(each) for each in ([part.rest for part in parts], [part.places for part in parts]))
    moved = np.array([np.concatenate(piece.points(each)[::-1]) for each in positions], dtype=np.float32)
    mesh = MovingMesh(rest, places / size, _wound(rest, triangles), moved)
    box = (float(corner[0]), float(corner[1]), float(size[0]), float(size[1]))
    return PuppetPiece(name, bled(_fitting(shown)), box, blend, mesh)


def _within(layer: ArtLayer, canvas: PixelBox) -> NDArray[np.uint8]:
    """The pixels of a layer in a box, with its opacity, uint8, shape [box height, box width, 4]."""
    whole = np.zeros((canvas.height, canvas.width, 4), dtype=np.float32)
    left, top, right, bottom = layer.box
    x0, x1 = max(left, canvas.left), min(right, canvas.right)
    y0, y1 = max(top, canvas.top), min(bottom, canvas.bottom)
    if x0 < x1 and y0 < y1:
        most = np.float32(np.iinfo(layer.pixels.dtype).max / 255)
        own = layer.pixels[y0 - top : y1 - top, x0 - left : x1 - left]
        whole[y0 - canvas.top : y1 - canvas.top, x0 - canvas.left : x1 - canvas.left] = own / most
    whole[..., 3] *= np.float32(layer.opacity)
    return np.rint(whole).astype(np.uint8)


def _trimmed(pixels: NDArray[np.uint8], canvas: PixelBox) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """What is drawn of a box, with a margin, and left and top of that [px]."""
    left, top, width, height = cv2.boundingRect((pixels[..., 3] > 0).astype(np.uint8))
    shown = np.pad(
        pixels[top : top + max(1, height), left : left + max(1, width)], ((_MARGIN, _MARGIN),) * 2 + ((0, 0),)
    )
    return shown, np.array([canvas.left + left - _MARGIN, canvas.top + top - _MARGIN], dtype=np.float64)


def _below_one_another(one: NDArray[np.uint8], other: NDArray[np.uint8]) -> NDArray[np.uint8]:
    width = max(one.shape[1], other.shape[1])
    return np.concatenate([np.pad(each, ((0, 0), (0, width - each.shape[1]), (0, 0))) for each in (one, other)])


def _fitting(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """A picture that a graphics card takes: smaller, where it is larger than that."""
    height, width = pixels.shape[:2]
    scale = _LONGEST / max(height, width)
    return pixels if scale >= 1 else resized(pixels, max(1, int(width * scale)), max(1, int(height * scale)))


def _wound(rest: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles that all wind counter-clockwise with y up."""
    a, b, c = (rest[triangles[:, k]] for k in range(3))
    clockwise = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] > 0
    return np.where(clockwise[:, None], triangles[:, [0, 2, 1]], triangles)
