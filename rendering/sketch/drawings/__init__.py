"""Line drawing networks: informative drawings and the sketch U-Net, with their public weights."""

from __future__ import annotations

from .configuration import InformativeDrawingsConfiguration, SketchUNetConfiguration
from .files import DRAWING_FILES

__all__ = [
    "DRAWING_FILES",
    "InformativeDrawingsConfiguration",
    "SketchUNetConfiguration",
]
