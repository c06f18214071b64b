"""Line drawings: from the illustration, and bent along with the motion (paper, Method, "Sketch Warping")."""

from __future__ import annotations

from .layered_sketch import LayeredSketch
from .line_tones import LINE_TONES, LineTones, dark_lines, has_light_lines, sized_sketch
from .sketch import cleaned, extract_sketch
from .sketch_warping import WARP_MODES, WarpMode, warped_sketches
from .splatting import splats_of
from .warp import forward_warp, warp_sketch

__all__ = [
    "LINE_TONES",
    "WARP_MODES",
    "LayeredSketch",
    "LineTones",
    "WarpMode",
    "cleaned",
    "dark_lines",
    "extract_sketch",
    "forward_warp",
    "has_light_lines",
    "sized_sketch",
    "splats_of",
    "warp_sketch",
    "warped_sketches",
]
