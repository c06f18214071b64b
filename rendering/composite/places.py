"""Where the pixels of a moved mesh come from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, interpolate

__all__ = ["NOWHERE", "places"]

NOWHERE = -1e5
"""Far off every canvas, so that nothing is there to resample."""


def places(
    positions: NDArray[np.float64],
    triangles: NDArray[np.int64],
    rest: NDArray[np.float64],
    box: PixelBox,
    canvas: PixelBox,
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Column and row of a canvas at rest that each pixel of a box shows, far off it where no triangle is.

    Args:
        positions: of the vertices [px], shape [v, 2].
        triangles: shape [t, 3]; later ones win.
        rest: positions at rest [px], shape [v, 2].
        box: the pixels that are wanted.
        canvas: in whose pixels the places are told; pixel [0, 0] has its centre at (0, 0).

    Returns:
        Columns and rows, shape [box height, box width] each.
    """
    x, y = interpolate(positions, triangles, rest - positions, box, fill=NOWHERE)
    x += (np.arange(box.left, box.right) - canvas.left).astype(np.float32)
    y += (np.arange(box.top, box.bottom) - canvas.top).astype(np.float32)[:, None]
    return x, y
