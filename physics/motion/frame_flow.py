"""Motion vectors: how what is seen in a frame goes on to the next frame and came from the one before.

As the flow from the drawing, they are affine in each triangle, but of the meshes as they are in the frame: each pixel
has the vectors of the frontmost triangle that covers its centre there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import require
from ..mesh import PixelBox, barycentric, triangle_ids
from .flow import all_triangles, without_covered
from .motion import Motion

__all__ = ["FrameFlow", "MotionVectors"]


@dataclass(frozen=True, eq=False)
class MotionVectors:
    """Where what each pixel of a frame shows will be, and was.

    Attributes:
        forward: from this frame to the next, x right and y down [px], float32, shape [h, w, 2]; 0 outside the bodies.
        backward: from this frame to the one before, the same.
        inside: true where a body is in this frame, bool, shape [h, w].
    """

    forward: NDArray[np.float32]
    backward: NDArray[np.float32]
    inside: NDArray[np.bool_]


class FrameFlow:
    """The motion vectors of every frame of a motion, computed one frame at a time when asked for.

    A loop's last frame leads to its first. Otherwise the first frame came, and the last one goes on, as the motion does
    beside it: its vector is the other one, turned round.

    Attributes:
        motion: whose vectors they are.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import FrameFlow, Motion
        >>> from physanimator.physics.scene import Body
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> positions = np.float32([mesh.vertices + (step, 0) for step in (0, 3, 4)])
        >>> vectors = FrameFlow(Motion((Body(mesh),), positions, frame_rate=24.0)).vectors(1)
        >>> vectors.forward[30, 51].round(3).tolist(), vectors.backward[30, 51].round(3).tolist()
        ([1.0, 0.0], [-3.0, 0.0])
    """

    def __init__(self, motion: Motion) -> None:
        self.motion = motion
        self._triangles = all_triangles(motion.bodies)

    def __len__(self) -> int:
        """Number of frames."""
        return len(self.motion)

    def __iter__(self) -> Iterator[MotionVectors]:
        """The vectors of each frame in turn."""
        return (self.vectors(t) for t in range(len(self)))

    def vectors(self, t: int) -> MotionVectors:
        """The vectors of frame ``t``.

        Raises:
            InvalidInputError: there is no such frame.
        """
        require("frame", t, 0 <= t < len(self), f"0 to {len(self) - 1}")
        now = self.motion.positions[t].astype(np.float64)
        box = PixelBox(0, 0, self.motion.width, self.motion.height)
        ids = without_covered(triangle_ids(now, self._triangles, box), self.motion.bodies)
        inside = ids >= 0
        corners = self._triangles[ids[inside]]
        rows, columns = np.nonzero(inside)
        centres = np.stack([columns, rows], axis=1).astype(np.float64) + 0.5
        weights = np.clip(barycentric(centres, now[corners]), 0, 1)
        forward, backward = (
            _spread(moved[corners], weights, inside) for moved in (self._after(t) - now, self._before(t) - now)
        )
        return MotionVectors(forward, backward, inside)

    def _after(self, t: int) -> NDArray[np.float64]:
        return self._at(t + 1)

    def _before(self, t: int) -> NDArray[np.float64]:
        return self._at(t - 1)

    def _at(self, t: int) -> NDArray[np.float64]:
        """Positions in a frame, of which there may be one too few at each end."""
        positions, count = self.motion.positions, len(self)
        if 0 <= t < count or self.motion.loop is not None:
            return positions[t % count].astype(np.float64)
        end, beside = (0, 1) if t < 0 else (count - 1, count - 2)
        if count == 1:
            return positions[0].astype(np.float64)
        return 2.0 * positions[end] - positions[beside]


def _spread(
    values: NDArray[np.float64], weights: NDArray[np.float64], inside: NDArray[np.bool_]
) -> NDArray[np.float32]:
    """Values at corners, shape [n, 3, 2], as a field over the pixels inside, 0 elsewhere."""
    field = np.zeros((*inside.shape, 2), dtype=np.float32)
    field[inside] = np.einsum("nkc,nk->nc", values, weights)
    return field
