"""Flow-warp error (Lai et al., "Learning blind video temporal consistency", ECCV 2018) along the simulation's own flow.

A point of the drawing is followed through the frames. Wherever it is seen, it should have the same colour; where it is
hidden by another part, folded under or outside the picture, it is left out.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox, interpolate, triangle_ids
from ...physics.motion import FlowSequence, Motion, layer_order, without_covered

__all__ = ["FlowWarpError", "RestMaps"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Edges of a body are mixed with what is behind them [px].
_EDGE = 2
# A point is seen where the mesh that covers its place shows the drawing from so near by [px].
_SAME = 1.0
# Far outside of any picture.
_NOWHERE = -1e4
# Places are read in rows of this length: OpenCV takes at most 32767 in one.
_ROW = 1024


class RestMaps:
    """Which point of the drawing is seen at each pixel of a frame.

    Attributes:
        flow: of the motion.
    """

    def __init__(self, motion: Motion) -> None:
        self.flow = FlowSequence(motion)
        starts = np.cumsum([0] + [len(body.mesh.vertices) for body in motion.bodies])
        self._rest = np.concatenate([body.mesh.vertices for body in motion.bodies])
        order = layer_order(motion.bodies)
        self._triangles = np.concatenate([motion.bodies[k].mesh.triangles + starts[k] for k in order])
        self._box = PixelBox(0, 0, motion.width, motion.height)

    def seen(self, t: int) -> FloatImage:
        """Position in the drawing of what each pixel of a frame shows [px], far outside for none, shape [h, w, 2]."""
        positions, bodies = self.flow.motion.positions[t], self.flow.motion.bodies
        seen = np.dstack(list(interpolate(positions, self._triangles, self._rest, self._box, fill=_NOWHERE)))
        if any(body.cover is not None for body in bodies):
            seen[~self.covered(t)] = _NOWHERE
        return seen

    def covered(self, t: int) -> Mask:
        """Where bodies are seen in a frame, shape [h, w]."""
        motion = self.flow.motion
        return without_covered(triangle_ids(motion.positions[t], self._triangles, self._box), motion.bodies) >= 0


class FlowWarpError:
    """Is fed the frames of a clip one after the other.

    Attributes:
        to_previous: mean difference of colour of all points that are seen in a frame and in the one before, 0..1; None
            before the second frame.
        to_first: the same of each frame and the first.
    """

    def __init__(self, maps: RestMaps) -> None:
        self._maps, self._t = maps, 0
        kernel = np.ones((2 * _EDGE + 1,) * 2, np.uint8)
        inner = cv2.erode(maps.flow.inside.astype(np.uint8), kernel, borderType=cv2.BORDER_REPLICATE) > 0
        self._row, self._column = (index.astype(np.float32) for index in np.nonzero(inner))
        self._inner = inner
        self._first: tuple[FloatImage, Mask] | None = None
        self._previous: tuple[FloatImage, Mask] | None = None
        self._to_previous: list[float] = []
        self._to_first: list[float] = []

    def add(self, frame: FloatImage) -> None:
        """The next frame, RGB 0..1, shape [h, w, 3]."""
        now = self._followed(frame)
        self._t += 1
        if self._previous is not None and self._first is not None:
            self._to_previous += _difference(self._previous, now)
            self._to_first += _difference(self._first, now)
        self._previous, self._first = now, self._first or now

    @property
    def to_previous(self) -> float | None:
        return float(np.mean(self._to_previous)) if self._to_previous else None

    @property
    def to_first(self) -> float | None:
        return float(np.mean(self._to_first)) if self._to_first else None

    def _followed(self, frame: FloatImage) -> tuple[FloatImage, Mask]:
        """Colour of each point in a frame, shape [n, 3], and whether it is seen there, shape [n]."""
        moved = self._maps.flow.flow(self._t).displacement[self._inner]
        x, y = self._column + moved[:, 0], self._row + moved[:, 1]
        height, width = frame.shape[:2]
        within = (x >= 0) & (x <= width - 1) & (y >= 0) & (y <= height - 1)
        seen = self._maps.seen(self._t)
        column, row = (np.clip(np.rint(v), 0, side - 1).astype(int) for v, side in ((x, width), (y, height)))
        # The pixel nearest to the place shows a point of the drawing a fraction of a pixel beside this one.
        near = np.abs(seen[row, column] - np.stack([self._column, self._row], axis=1) - 0.5).max(axis=1, initial=0)
        return _sampled(frame, x, y), within & (near <= _SAME)


def _sampled(frame: FloatImage, x: NDArray[np.float32], y: NDArray[np.float32]) -> FloatImage:
    """Bilinear colours at places, pixel [0, 0] having its centre at (0, 0), shape [n, 3]."""
    padded = np.zeros((2, -(-max(len(x), 1) // _ROW) * _ROW), dtype=np.float32)
    padded[0, : len(x)], padded[1, : len(x)] = x, y
    places = padded.reshape(2, -1, _ROW)
    colours = cv2.remap(frame, places[0], places[1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return colours.reshape(-1, 3)[: len(x)]


def _difference(one: tuple[FloatImage, Mask], other: tuple[FloatImage, Mask]) -> list[float]:
    both = one[1] & other[1]
    return [float(np.abs(one[0][both] - other[0][both]).mean())] if both.any() else []
