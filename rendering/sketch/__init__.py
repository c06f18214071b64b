"""Line drawings: from the illustration, and bent along with the motion (paper, Method, "Sketch Warping")."""

from __future__ import annotations

from .layered_sketch import LayeredSketch
from .sketch import cleaned, extract_sketch
from .sketch_warping import WARP_MODES, WarpMode, warped_sketches
from .splatting import splats_of
from .warp import forward_warp, warp_sketch

__all__ = [
    "WARP_MODES",
    "LayeredSketch",
    "WarpMode",
    "cleaned",
    "extract_sketch",
    "forward_warp",
    "splats_of",
    "warp_sketch",
    "warped_sketches",
]
