"""An illustration with transparency taken apart: a clean plate that is transparent itself, and a layer for each body.

All is as in ``cutting`` for an opaque illustration, P = T + (1 - a) B, with premultiplied colours and their alpha as
a fourth one. Textures have a, how much a body covers of what is behind it, as a fifth channel. Where nothing is
behind, that is the illustration's own alpha, which is known and need not be solved for.
"""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.mesh import TriangleMesh
from ..matting import FAINT, SQUARE, WIDE, fitting_plate, grown, mixed_rim, regular_mask, soft_alpha, with_outline
from ..pictures import carried_on, over, premultiplied
from ..plate import fill_hole
from .beyond_border import on_canvas
from .cutting import aproned, picture_beneath
from .layer import Layer
from .silhouette import ALL, continued_silhouette, thrice
from .still_layers import StillLayer, still_layer

__all__ = ["sprite_hole", "sprite_plate", "take_sprite_apart"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Alpha from which a pixel counts as opaque.
_OPAQUE = 0.95
# Colours nearer than this to the silhouette are those of its outline [px].
_OUTLINE = 4
# Strips beside a mask that are no wider than this belong to it when nothing but transparency lies beyond [px].
_STRIP = 3


def take_sprite_apart(
    picture: FloatImage, masks: Sequence[FloatImage], meshes: Sequence[TriangleMesh | None], *, plate: FloatImage | None
) -> tuple[FloatImage, list[Layer | StillLayer]]:
    """Peel the bodies off a picture with transparency, the front one first; see :func:`cutting.take_apart`.

    Args:
        picture: straight RGBA in 0 to 1, shape [h, w, 4].
        masks: soft mask of each body, from back to front, shape [h, w] each.
        meshes: mesh of each body, from back to front; None for what stands still in front of bodies.
        plate: what is behind all bodies, straight RGBA, shape [h, w, 4], or RGB, shape [h, w, 3], whose transparency
            is then found; None makes a clean plate.

    Returns:
        The plate, premultiplied RGBA, equal to the picture wherever no body is; and a layer for each body, from back
        to front.
    """
    flat = over(picture)
    masks = [_regular(flat, picture[..., 3], mask) for mask in masks]
    supports = [_with_strips(with_outline(flat, mask), picture[..., 3]) for mask in masks]
    hole = sprite_hole(masks, supports)
    if plate is None or plate.shape[2] == 3:
        plate = _filled(picture, hole, plate)
    shown, behind = premultiplied(picture), premultiplied(plate)
    layers: list[Layer | StillLayer] = []
    for number in range(len(masks) - 1, -1, -1):
        beneath = np.dstack(
            [
                picture_beneath(shown[..., :3], behind[..., :3], masks, supports, number),
                picture_beneath(thrice(shown[..., 3]), thrice(behind[..., 3]), masks, supports, number)[..., 0],
            ]
        )
        share = soft_alpha(_over_white(shown), _over_white(beneath), masks[number], supports[number])
        share = _fitting_share(share, shown[..., 3], beneath[..., 3], supports[number])
        layer, shown = _peeled(shown, beneath, share, meshes[number])
        layers = layers if layer is None else [layer, *layers]
    return shown, layers


def _peeled(
    shown: FloatImage, beneath: FloatImage, share: FloatImage, mesh: TriangleMesh | None
) -> tuple[Layer | StillLayer | None, FloatImage]:
    """The layer of one body or still part, and the premultiplied picture without it."""
    if mesh is not None:
        wider, canvas, covered = aproned(mesh, share)
        share = np.where(covered, share, np.float32(0))
    below = fitting_plate(shown, beneath, share)
    below[..., :3] = np.minimum(below[..., :3], below[..., 3:])
    colour = shown - (1 - share[..., None]) * below
    if mesh is None:
        return still_layer(np.dstack([colour, share])), below
    return Layer(wider, canvas, np.dstack([on_canvas(colour, canvas), on_canvas(share, canvas)])), below


def _regular(flat: FloatImage, opacity: FloatImage, mask: FloatImage) -> FloatImage:
    """A mask whose edge lies where the picture has one: the silhouette is an edge whatever the colours along it."""
    return regular_mask(np.dstack([flat, opacity]), mask)


def sprite_hole(masks: Sequence[FloatImage], supports: Sequence[Mask]) -> Mask:
    """All pixels that may show something of a body, shape [h, w].

    Raises:
        InvalidInputError: these are all of the picture.
    """
    hole = np.logical_or.reduce([each | mixed_rim(mask, each) for mask, each in zip(masks, supports, strict=True)])
    if hole.all():
        raise InvalidInputError("masks must leave some of the picture as background. Got: they cover all of it")
    return hole


def sprite_plate(picture: FloatImage, mask: FloatImage) -> FloatImage:
    """A picture without what a mask shows: see :func:`clean_plate`.

    Args:
        picture: straight RGBA in 0 to 1, shape [h, w, 4].
        mask: soft mask in 0 to 1, shape [h, w].

    Returns:
        Straight RGBA, shape [h, w, 4].

    Raises:
        InvalidInputError: the mask leaves nothing of the picture.
    """
    flat = over(picture)
    regular = _regular(flat, picture[..., 3], mask)
    support = _with_strips(with_outline(flat, regular) | (mask > FAINT), picture[..., 3])
    return _filled(picture, sprite_hole([regular], [support]), None)


def _filled(picture: FloatImage, hole: Mask, given: FloatImage | None) -> FloatImage:
    """The picture with its hole filled, straight RGBA; with colours that are given instead, if they are."""
    if not hole.any():
        return picture
    opacity = np.where(hole, continued_silhouette(picture[..., 3], hole), picture[..., 3])
    colours = _filled_colours(picture, hole) if given is None else given
    return np.dstack([np.where(hole[..., None], colours, picture[..., :3]), opacity])


def _filled_colours(picture: FloatImage, hole: Mask) -> FloatImage:
    """Colours continued into a hole from the opaque surroundings alone, shape [h, w, 3]."""
    colours, opaque = picture[..., :3], (picture[..., 3] > _OPAQUE) & ~hole
    if not opaque.any():
        return colours
    # Beyond the silhouette its outline must not go on, which would run into the hole from there.
    inner = cv2.erode(opaque.astype(np.uint8) | hole, np.ones((2 * _OUTLINE + 1,) * 2, np.uint8)) > 0
    known = opaque & inner
    known = known if known.any() else opaque
    around = np.where((opaque | hole)[..., None], colours, carried_on(colours, known.astype(np.float32)))
    return fill_hole(around, hole)


def _with_strips(support: Mask, opacity: FloatImage) -> Mask:
    """A part with the narrow strips between it and transparency, which a mask that is a little too small leaves."""
    rest = (opacity > FAINT) & ~support
    square = np.ones((_STRIP + 2,) * 2, np.uint8)
    # The corners of what is wide are no strips either.
    wide = cv2.dilate(cv2.erode(rest.astype(np.uint8), square), square, iterations=3) > 0
    strips = rest & ~wide & grown(opacity <= FAINT, WIDE)
    joined = support.copy()
    for _ in range(_STRIP):
        joined |= strips & grown(joined, SQUARE)
    return joined


def _fitting_share(share: FloatImage, opacity: FloatImage, behind: FloatImage, support: Mask) -> FloatImage:
    """The alpha of a body between two bounds that the picture's transparency sets.

    Least, within its support: enough that the body over what is behind gives the alpha of the picture. Most: the alpha
    of the picture itself, so that a see-through body lets through whatever it moves in front of; where the picture is
    opaque, what is behind may be too, and the bound is higher.
    """
    least = np.clip((opacity - behind) / np.maximum(1 - behind, np.float32(1e-6)), 0, 1)
    most = np.where(opacity > _OPAQUE, 1 - (1 - opacity) * (1 - behind), opacity)
    share = np.minimum(np.where(support, np.maximum(share, least), share), most)
    return np.where(share > 1 - ALL, np.float32(1), share)


def _over_white(image: FloatImage) -> FloatImage:
    """Premultiplied RGBA over white, shape [h, w, 3]."""
    return np.asarray(image[..., :3] + (1 - image[..., 3:]), dtype=np.float32)
