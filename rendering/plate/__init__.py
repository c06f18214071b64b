"""The clean plate: what is behind the moving parts, filled in with colours, lines and texture from around them."""

from __future__ import annotations

from .colour_spreading import spread_colours
from .line_continuation import continue_lines
from .plate import clean_plate, fill_hole

__all__ = [
    "clean_plate",
    "continue_lines",
    "fill_hole",
    "spread_colours",
]
