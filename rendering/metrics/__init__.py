"""How good frames are, without weights: flow-warp error, stillness, closeness to the sketches."""

from __future__ import annotations

from .metrics import measure_clip
from .sketch_distance import chamfer_distance

__all__ = [
    "chamfer_distance",
    "measure_clip",
]
