"""Soft alpha along the outline of a part, from a mask that may be rough."""

from __future__ import annotations

from .edges_within import OpenEdge, open_edges
from .mask_edges import FAINT, SQUARE, WIDE, grown
from .matte import fitting_plate, in_levels, mixed_rim, soft_alpha, with_outline
from .part_meshes import part_mesh, shown_part
from .regularisation import regular_mask

__all__ = [
    "FAINT",
    "SQUARE",
    "WIDE",
    "OpenEdge",
    "fitting_plate",
    "grown",
    "in_levels",
    "mixed_rim",
    "open_edges",
    "part_mesh",
    "regular_mask",
    "shown_part",
    "soft_alpha",
    "with_outline",
]
