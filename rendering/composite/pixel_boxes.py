"""Boxes of pixels beside and within one another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ...physics.mesh import PixelBox

__all__ = ["around", "bands_of", "shared", "within"]


def around(boxes: Sequence[PixelBox]) -> PixelBox:
    """The smallest box that holds all of these; of no width or height where there are none."""
    if not boxes:
        return PixelBox(0, 0, 0, 0)
    return PixelBox(
        min(box.left for box in boxes),
        min(box.top for box in boxes),
        max(box.right for box in boxes),
        max(box.bottom for box in boxes),
    )


def bands_of(boxes: Sequence[PixelBox], rows: int) -> Iterator[PixelBox]:
    """Boxes of so many rows, from top to bottom, that hold all of these, each as wide as what is in it."""
    whole = around(boxes)
    for top in range(whole.top, whole.bottom, rows):
        band = PixelBox(whole.left, top, whole.right, min(top + rows, whole.bottom))
        parts = [shared(box, band) for box in boxes]
        yield around([part for part in parts if part.width > 0 and part.height > 0])


def shared(one: PixelBox, other: PixelBox) -> PixelBox:
    """The pixels of both boxes; of no width or height where they have none in common."""
    return PixelBox(
        max(one.left, other.left), max(one.top, other.top), min(one.right, other.right), min(one.bottom, other.bottom)
    )


def within(box: PixelBox, outer: PixelBox) -> PixelBox:
    """A box in the pixels of another that holds it."""
    return PixelBox(box.left - outer.left, box.top - outer.top, box.right - outer.left, box.bottom - outer.top)
