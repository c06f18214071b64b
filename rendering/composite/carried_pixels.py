"""How a moved mesh carries whole pixels along."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, TriangleMesh, bounding_box, interpolate, triangle_ids
from .apron import ApronedMesh, canvas_of, usual_reach
from .beyond_border import on_canvas

__all__ = ["CarriedPixels"]

Places = NDArray[np.int32]
Mask = NDArray[np.bool_]

# Where the mesh is not; no picture is so wide that a place on it could be taken for this.
_NOWHERE = -1e6


class CarriedPixels:
    """A body's mesh with an apron, and how it carries pixels along."""

    def __init__(self, mesh: TriangleMesh, mask: Mask, block: int) -> None:
        reach = max(usual_reach(mesh), 2 * block)
        canvas = canvas_of(mesh, reach=reach)
        shape = mask.astype(np.float32).repeat(block, axis=0).repeat(block, axis=1)
        self._mesh = ApronedMesh.around(mesh, on_canvas(shape, canvas), canvas, reach=reach)
        self._block = block
        whole = PixelBox(0, 0, mesh.width, mesh.height)
        half = block // 2
        self.covered = (triangle_ids(self._mesh.rest, self._mesh.triangles, whole) >= 0)[half::block, half::block]

    def moved(self, pixels: Places, vertices: NDArray[np.float32], width: int, height: int) -> Places:
        """The pixels with the mesh moved, -1 where the body is not.

        Args:
            pixels: which pixel of the illustration the body shows at rest, -1 where it is not, shape [h, w] in blocks.
            vertices: positions of the body's vertices [px], shape [v, 2].
            width: of the picture [px].
            height: of the picture [px].
        """
        found = np.full(pixels.shape, -1, dtype=np.int32)
        points, block = self._mesh.positions(vertices), self._block
        box = bounding_box(points).clipped(width, height)
        if not (box.width and box.height):
            return found
        x, y = interpolate(points, self._mesh.triangles, self._mesh.rest - points, box, fill=_NOWHERE)
        half = block // 2
        # The blocks whose middle lies in the box.
        rows = np.arange(-((half - box.top) // block), -((half - box.bottom) // block))
        columns = np.arange(-((half - box.left) // block), -((half - box.right) // block))
        at = np.ix_(rows * block + half - box.top, columns * block + half - box.left)
        # Beyond the picture's border the body goes on as it is there; beyond the mesh there is nothing.
        row, column = (
            np.clip(np.rint(way[at] / block + here), 0, count - 1).astype(np.int64)
            for way, here, count in ((y, rows[:, None], pixels.shape[0]), (x, columns[None], pixels.shape[1]))
        )
        found[np.ix_(rows, columns)] = np.where(x[at] > _NOWHERE / 2, pixels[row, column], -1)
        return found
