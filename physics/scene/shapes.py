"""Shapes in the picture: where colliders are and paint lies."""

from __future__ import annotations

from dataclasses import dataclass

from ..errors import require
from ..fields import Field
from ..rig import MaskRegion, Polygon

__all__ = ["LayerRegion", "Shape", "shape_field"]

Shape = Polygon | MaskRegion


@dataclass(frozen=True, eq=False)
class LayerRegion(MaskRegion):
    """What is drawn on a layer of an artwork.

    Attributes:
        mask: where that is, bool, shape [h, w].
        name: of the layer.
    """

    name: str = ""


def shape_field(about: str) -> Field:
    """A field that holds a shape."""
    return Field("Region", about, check=_checked_shape)


def _checked_shape(name: str, shape: object) -> object:
    require(name, type(shape).__name__, isinstance(shape, Polygon | MaskRegion), "a polygon or a mask")
    return shape
