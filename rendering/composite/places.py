"""Where the pixels of a moved mesh come from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, interpolate

__all__ = ["NOWHERE", "places"]

NOWHERE = -1e5
"""Far off every canvas, so that nothing is there to resample."""

# Triangles so far around a box are rasterised for it [px].
_BESIDE = 1


def places(
    positions: NDArray[np.float64],
    triangles: NDArray[np.int64],
    rest: NDArray[np.float64],
    box: PixelBox,
    canvas: PixelBox,
    *,
    scale: int = 1,
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Column and row of a canvas at rest that each pixel of a box shows, far off it where no triangle is.

    Args:
        positions: of the vertices [px], shape [v, 2].
        triangles: shape [t, 3]; later ones win.
        rest: positions at rest [px], shape [v, 2].
        box: the pixels that are wanted.
        canvas: in whose pixels the places are told; pixel [0, 0] has its centre at (0, 0).
        scale: how many pixels of the box a pixel of the picture is wide.

    Returns:
        Columns and rows, shape [box height, box width] each.
    """
    if scale != 1:
        corners = positions[triangles] * scale
        low, high = corners.min(axis=1), corners.max(axis=1)
        near = (high >= (box.left - _BESIDE, box.top - _BESIDE)).all(axis=1)
        near &= (low <= (box.right + _BESIDE, box.bottom + _BESIDE)).all(axis=1)
        triangles = triangles[near]
    x, y = interpolate(positions * scale, triangles, rest - positions, box, fill=NOWHERE)
    x += ((np.arange(box.left, box.right) + 0.5) / scale - 0.5 - canvas.left).astype(np.float32)
    y += ((np.arange(box.top, box.bottom) + 0.5) / scale - 0.5 - canvas.top).astype(np.float32)[:, None]
    return x, y
