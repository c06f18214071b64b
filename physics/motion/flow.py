"""Optical flow F(0 -> t) of a motion: how far each pixel of the drawing has moved (paper, Method, "Optical Flow").

d(p) = phi_i(X_p, t) - X_p for the triangle i of the rest mesh that holds pixel p, where phi_i is affine: the
displacements of its three vertices, weighted by the pixel's barycentric coordinates. The weights do not depend
on time, so one sparse matrix holds them for all frames.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import require
from ..mesh import PixelBox, barycentric, triangle_ids
from ..scene import Body
from .motion import Motion

__all__ = ["FlowField", "FlowSequence", "all_triangles", "layer_order", "without_covered"]


@dataclass(frozen=True, eq=False)
class FlowField:
    """The flow from the drawing to one frame.

    Attributes:
        displacement: of each pixel of the drawing, x right and y down [px], float32, shape [h, w, 2]; zero outside
            the bodies.
        inside: true where a body lies in the drawing, bool, shape [h, w].
        covered: true where something still is in front of all bodies, bool, shape [h, w]; None for nowhere.
    """

    displacement: NDArray[np.float32]
    inside: NDArray[np.bool_]
    covered: NDArray[np.bool_] | None = None


def layer_order(bodies: Sequence[Body]) -> list[int]:
    """Numbers of bodies from back to front: by layer, and of equal layers the later body in front.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import layer_order
        >>> from physanimator.physics.scene import Body
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> layer_order([Body(mesh, layer=2), Body(mesh, layer=1)])
        [1, 0]
    """
    return sorted(range(len(bodies)), key=lambda number: bodies[number].layer)


def all_triangles(bodies: Sequence[Body]) -> NDArray[np.int64]:
    """Triangles of all bodies from back to front, indexing the vertices of their motion, shape [t, 3]."""
    starts = np.cumsum([0] + [len(body.mesh.vertices) for body in bodies])
    return np.concatenate([bodies[k].mesh.triangles + starts[k] for k in layer_order(bodies)])


def without_covered(ids: NDArray[np.int32], bodies: Sequence[Body]) -> NDArray[np.int32]:
    """Rows of all bodies' triangles from back to front that are seen, -1 where something still is in front of them.

    Args:
        ids: row at each pixel, -1 for none, shape [h, w].
        bodies: whose triangles they are, one after another in their layer order.
    """
    if all(body.cover is None for body in bodies):
        return ids
    order = layer_order(bodies)
    ends = np.cumsum([0] + [len(bodies[k].mesh.triangles) for k in order])
    seen = ids.copy()
    for rank, number in enumerate(order):
        cover = bodies[number].cover
        if cover is not None:
            seen[cover & (ids >= ends[rank]) & (ids < ends[rank + 1])] = -1
    return seen


class FlowSequence:
    """The flow of every frame of a motion, computed one frame at a time when asked for.

    Where bodies overlap in the drawing, a pixel belongs to the body in front, and where something that stands still is
    in front of that, to none: it does not move.

    Attributes:
        motion: whose flow it is.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import FlowSequence, Motion
        >>> from physanimator.physics.scene import Body
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> FlowSequence(motion).flow(1).displacement[30, 30].round(3).tolist()
        [3.0, 0.0]
    """

    def __init__(self, motion: Motion) -> None:
        self.motion = motion

    def __len__(self) -> int:
        """Number of frames."""
        return len(self.motion)

    def __iter__(self) -> Iterator[FlowField]:
        """The flow of each frame in turn."""
        return (self.flow(t) for t in range(len(self)))

    def flow(self, t: int) -> FlowField:
        """The flow from the drawing to frame ``t``.

        Raises:
            InvalidInputError: there is no such frame.
        """
        require("frame", t, 0 <= t < len(self), f"0 to {len(self) - 1}")
        displacement = np.zeros((self.motion.height, self.motion.width, 2), dtype=np.float32)
        moved = self._weights @ (self.motion.positions[t] - self._rest.astype(np.float32))
        # As one complex number a pixel, the pairs are written several times faster than as rows of two.
        displacement.view(np.complex64).reshape(-1)[self._pixels] = moved.view(np.complex64).reshape(-1)
        return FlowField(displacement, self.inside, self._covered)

    @cached_property
    def body(self) -> NDArray[np.int32]:
        """Number of the body that each pixel of the drawing belongs to, -1 for none, int32, shape [h, w]."""
        sizes = [len(self.motion.bodies[k].mesh.triangles) for k in layer_order(self.motion.bodies)]
        owner = np.repeat(layer_order(self.motion.bodies), sizes)
        return _frozen(np.where(self._ids >= 0, owner[self._ids], -1).astype(np.int32))

    @cached_property
    def inside(self) -> NDArray[np.bool_]:
        """True where a body lies in the drawing, bool, shape [h, w]."""
        return _frozen(self._ids >= 0)

    @cached_property
    def _covered(self) -> NDArray[np.bool_] | None:
        covers = [body.cover for body in self.motion.bodies]
        if not covers or any(cover is None for cover in covers):
            return None
        return _frozen(np.logical_and.reduce([cover for cover in covers if cover is not None]))

    @cached_property
    def _rest(self) -> NDArray[np.float64]:
        return np.concatenate([body.mesh.vertices for body in self.motion.bodies])

    @cached_property
    def _triangles(self) -> NDArray[np.int64]:
        """See :func:`all_triangles`."""
        return all_triangles(self.motion.bodies)

    @cached_property
    def _ids(self) -> NDArray[np.int32]:
        """Row of ``_triangles`` at each pixel of the drawing, -1 for none, shape [h, w]."""
        ids = triangle_ids(self._rest, self._triangles, PixelBox(0, 0, self.motion.width, self.motion.height))
        return without_covered(ids, self.motion.bodies)

    @cached_property
    def _pixels(self) -> NDArray[np.int64]:
        """Flat indices of the pixels inside, shape [n]."""
        return np.flatnonzero(self._ids >= 0)

    @cached_property
    def _weights(self) -> Any:
        """Barycentric coordinates of each pixel inside: a sparse matrix, shape [n, v]."""
        from scipy.sparse import csr_array

        corners = self._triangles[self._ids.reshape(-1)[self._pixels]].astype(np.int32)
        row, column = np.divmod(self._pixels, self.motion.width)
        weights = barycentric(np.stack([column + 0.5, row + 0.5], axis=1), self._rest[corners])
        ends = np.arange(0, corners.size + 1, 3, dtype=np.int32)
        shape = (len(corners), len(self._rest))
        return csr_array((weights.astype(np.float32).reshape(-1), corners.reshape(-1), ends), shape=shape)


def _frozen(array: Any) -> Any:
    array.setflags(write=False)
    return array
