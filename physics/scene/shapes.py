"""Shapes in the picture: where colliders are and paint lies."""

from __future__ import annotations

from ..errors import require
from ..fields import Field
from ..rig import MaskRegion, Polygon

__all__ = ["Shape", "shape_field"]

Shape = Polygon | MaskRegion


def shape_field(about: str) -> Field:
    """A field that holds a shape."""
    return Field("Region", about, check=_checked_shape)


def _checked_shape(name: str, shape: object) -> object:
    require(name, type(shape).__name__, isinstance(shape, Polygon | MaskRegion), "a polygon or a mask")
    return shape
