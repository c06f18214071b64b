"""Roots found from geometry: the crown of a head, what a head covers, the end that touches what stands still.

All work on a part in cells, so that they see the same whatever the mesh and the size of the picture.
"""

from __future__ import annotations

from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from .part_raster import PartRaster

__all__ = ["blown_from", "covered_root", "crown", "end_in_contact", "head", "on_face"]

BoolArray = NDArray[np.bool_]

_SPIKE = 0.15  # rows on top narrower than this share of the widest are a spike, such as a cowlick
# Hair of which a head would be more than this share is blown aside or cut short, and is held by a share of its height.
_LARGEST_HEAD, _SHORT = 0.5, 0.22
_ROUND = 0.8  # likeness of the top of hair to that of a disc from which on it lies on a head
_FOREHEAD = 0.6  # where hair leaves the forehead, in radii of the head from its top
_TO_CHIN, _FAR_BELOW = 2.5, 4.0  # hair that ends at the chin, and such that most of it hangs below [radii of the head]
_MOST = 0.5  # of hair before a face: share of its height that is held at most
_STRAND, _OF_STRAND = 0.12, 0.2  # hair of which a head would be less than this share is a strand; what is held of it
_AROUND = 1.8  # how far hair lies around a head that covers it [radii of the head]
_TOP = 0.25  # share of a part's extent that counts as its top
_TOUCHING = 0.5  # share of the top that has to touch something for the part to hang from it
_DEEP = 0.35  # what is held of a contact: from this share of its depth on
_THICK = 2.0  # a knot is so many times as thick as what hangs from it, usually
# What is thick lies so far aside in hair that is blown, as a share of its width, and so many times as far as up.
_ASIDE, _RATHER = 0.02, 1.5
_TRIED = 65  # places of a disc along a row
_SCATTERED = 0.05  # contact below this share of a part is none


def head(part: PartRaster) -> BoolArray:
    """What of hair lies on the head: all above the middle of the head, which hair frames."""
    (top, radius), rows = _head(part.inside), len(part.inside)
    return _down_to(part, top + (radius if radius <= _LARGEST_HEAD * rows else _SHORT * rows))


def blown_from(part: PartRaster) -> Literal["left", "right"] | None:
    """The side from which hair is blown that lies on no head: the thicker one; None where it hangs or lies on a head.

    Hair on a head is round on top, however its strands lie; a bundle of strands that is wider than tall is not, and its
    strands grow thinner from one side to the other rather than from its top down.
    """
    inside = part.inside
    if inside.shape[1] <= inside.shape[0] or _roundness(inside) >= _ROUND:
        return None
    room = cv2.distanceTransform(np.pad(inside, 1).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1]
    aside, down = (_lean(room.sum(axis=axis), inside.sum(axis=axis)) for axis in (0, 1))
    if abs(aside) < max(_ASIDE * inside.shape[1], _RATHER * abs(down)):
        return None
    return "left" if aside < 0 else "right"


def crown(part: PartRaster) -> BoolArray:
    """What of hair lies on the head above the forehead, for hair before a face that is drawn behind it, too."""
    (top, radius), rows = _head(part.inside), len(part.inside)
    return _down_to(
        part, top + (_OF_STRAND * rows if radius < _STRAND * rows else min(_FOREHEAD * radius, _MOST * rows))
    )


def on_face(part: PartRaster) -> float:
    """How much hair that hangs from a crown lies on the face: 1 if it ends at the chin, 0 far below or in a strand."""
    top, radius = _head(part.inside)
    reach = (len(part.inside) - top) / radius
    return float(np.clip((_FAR_BELOW - reach) / (_FAR_BELOW - _TO_CHIN), 0, 1))


def covered_root(part: PartRaster) -> BoolArray:
    """What the head covers of hair behind it, down to the chin, and what surrounds the head above its middle."""
    covered = _without_scatter(part.covered, part.inside)
    if not covered.any():
        return head(part)
    top, radius = _head(covered)
    rows, columns = np.mgrid[: covered.shape[0], : covered.shape[1]]
    middle = float(np.mean(columns[covered & (rows <= top + radius)]))
    around = np.hypot(rows - top - radius, columns - middle) <= _AROUND * radius
    return part.inside & ((covered & (rows <= top + 2 * radius)) | (around & (rows <= top + radius)))


def end_in_contact(part: PartRaster) -> BoolArray:
    """The end at which a tail, a ribbon or a cape touches what stands still: its top, if that does, else the deepest.

    Where nothing says so, the thickest place, if one is much thicker than the rest, as a knot is; otherwise nothing.
    """
    contact = _without_scatter(part.covered if part.covered.any() else part.resting, part.inside)
    free = part.inside & ~contact
    rows = np.nonzero(part.inside.any(axis=1))[0]
    top = part.inside & (np.arange(len(part.inside))[:, None] <= rows[0] + _TOP * (rows[-1] - rows[0]))
    if not contact.any() or not free.any():
        return _knot(part.inside)
    for touching in (contact, part.resting):  # an arm in front of the ends of a bow says nothing of its knot
        if (touching & top).sum() >= _TOUCHING * top.sum():
            return touching & top
    largest = _largest_patch(contact)
    depth = cv2.distanceTransform((~free).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return largest & (depth >= _DEEP * float(depth[largest].max()))


def _knot(shape: BoolArray) -> BoolArray:
    """The surroundings of the largest disc in a shape; nothing in a strip that is about as wide everywhere."""
    room = cv2.distanceTransform(np.pad(shape, 1).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1]
    middle = room[(room > 1) & (room >= cv2.dilate(room, np.ones((3, 3), np.uint8)))]
    if not len(middle) or room.max() < _THICK * np.median(middle):
        return np.zeros_like(shape)
    row, column = np.unravel_index(int(room.argmax()), room.shape)
    rows, columns = np.mgrid[: shape.shape[0], : shape.shape[1]]
    return shape & (np.hypot(rows - row, columns - column) <= room.max())


def _down_to(part: PartRaster, row: float) -> BoolArray:
    return part.inside & (np.arange(len(part.inside))[:, None] <= row)


def _head(shape: BoolArray) -> tuple[int, int]:
    """Row of the top of a head and its radius [cells]: the disc that fits in from above, as deep as it is wide.

    A row's width is that of all that lies between its ends, since hair frames a face.
    """
    widths = np.where(shape.any(axis=1), shape.shape[1] - shape.argmax(axis=1) - shape[:, ::-1].argmax(axis=1), 0)
    top = int(np.argmax(widths >= _SPIKE * widths.max()))
    depths = np.arange(1, len(widths) - top + 1)
    narrow = widths[top:] <= 2 * depths
    return top, int(depths[narrow.argmax()] if narrow.any() else depths[-1])


def _lean(room: NDArray[np.floating], amount: NDArray[np.integer]) -> float:
    """How far the middle of what is thick lies beside the middle of all along an axis [cells].

    Args:
        room: distances to the outline, summed up for each place of the axis.
        amount: cells at each place.
    """
    places = np.arange(len(amount))
    return float(np.average(places, weights=room) - np.average(places, weights=amount))


def _roundness(shape: BoolArray) -> float:
    """How alike the part of a shape above the middle of its head and the upper half of a disc are: their common share.

    Of the shape all counts that lies between the ends of a row; the disc is where it suits best.
    """
    top, radius = _head(shape)
    rows = shape[top : top + radius + 1]
    columns = np.arange(shape.shape[1])[None]
    span = np.logical_or.accumulate(rows, axis=1) & np.logical_or.accumulate(rows[:, ::-1], axis=1)[:, ::-1]
    depths = np.arange(len(rows))[:, None]
    half = np.sqrt(np.maximum(depths * (2 * radius - depths), 0))
    shares = []
    for middle in np.linspace(0, shape.shape[1], _TRIED):
        disc = np.abs(columns - middle) <= half
        shares.append((span & disc).sum() / (span | disc).sum())
    return float(max(shares))


def _without_scatter(contact: BoolArray, inside: BoolArray) -> BoolArray:
    """Contact where it is more than a grazing of the part."""
    return contact if contact.sum() >= _SCATTERED * inside.sum() else np.zeros_like(contact)


def _largest_patch(contact: BoolArray) -> BoolArray:
    count, labels, stats, _ = cv2.connectedComponentsWithStats(contact.astype(np.uint8))
    return np.asarray(labels == 1 + int(np.argmax(stats[1:count, cv2.CC_STAT_AREA])))
