"""Sketches taken apart into the lines of each body and those that stand still, and put together again in depth order.

Each body's lines are moved by its mesh, frame by frame from the drawing, so that they stay closed however far the mesh
stretches. The still lines are never resampled; a body hides those behind it, and nothing of a body's own lines is
among them, so that none stays at its old place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require
from ...physics.mesh import PixelBox, bounding_box, triangle_ids
from ...physics.motion import FlowSequence, Motion, layer_order
from ..composite import ApronedMesh, canvas_of, on_canvas
from ..pictures import as_float
from .warp import WarpedSketch

__all__ = ["LayeredSketch"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Ink fainter than this, 5 levels of 255, is no line.
_FAINT = 0.02
# Widest apron [px]: three times what contours usually stand out of a body.
_REACH = 12


class LayeredSketch:
    """Gives the sketch of any frame of a motion.

    Attributes:
        flow: of the motion.
        still: the lines that stand still and those behind the bodies, paper 1, lines towards 0, shape [h, w].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import FlowSequence, Motion
        >>> from physanimator.physics.scene import Body
        >>> from physanimator.rendering.sketch import LayeredSketch
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> sketch = np.ones((60, 60), np.float32)
        >>> sketch[:, 30] = 0
        >>> int(np.argmin(LayeredSketch(sketch, FlowSequence(motion)).frame(1).sketch[30]))
        33
    """

    def __init__(
        self,
        sketch: NDArray[Any],
        flow: FlowSequence,
        *,
        behind: NDArray[Any] | None = None,
        own: Sequence[NDArray[Any]] | None = None,
        border: int = 4,
    ) -> None:
        """Take a sketch apart.

        Args:
            sketch: of the drawing, paper 1, lines 0, shape [h, w].
            flow: of the motion.
            behind: sketch of what is behind the bodies, of the same form; without it paper is behind them.
            own: sketch of each body's own layer, hidden lines included, of the same form; without them nothing is
                known of lines that something in front hides in the drawing.
            border: contour lines that reach this far out of a body belong to it [px].

        Raises:
            InvalidInputError: sizes differ or a parameter is unusable.
        """
        sketch = as_float(sketch)
        size = (flow.motion.height, flow.motion.width)
        require("sketch", f"shape {sketch.shape}", sketch.ndim == 2, "of shape [h, w]")
        fits = sketch.shape == size
        require("flow", f"{size[1]} x {size[0]} px", fits, f"of the sketch's size, {sketch.shape[1::-1]} px")
        require("border", border, 0 <= border <= 20, "0 to 20 px")
        if behind is not None:
            require("behind", f"shape {np.shape(behind)}", np.shape(behind) == size, f"of the sketch's shape {size}")
        self.flow, lines = flow, 1 - sketch
        order = layer_order(flow.motion.bodies)
        owner = _owner(flow, lines, order, border)
        self._bared = owner >= 0
        beneath = np.float32(0) if behind is None else 1 - np.asarray(behind, dtype=np.float32)
        self.still = 1 - np.where(self._bared, beneath, lines)
        hidden = None if own is None else [1 - as_float(each) for each in own]
        self._layers = [
            _LineLayer.cut(lines, owner == k, flow, k, hidden=None if hidden is None else hidden[k]) for k in order
        ]

    def frame(self, t: int, *, blur_sigma: float = 0.8) -> WarpedSketch:
        """The sketch of one frame.

        Args:
            t: number of the frame.
            blur_sigma: Gaussian blur of the result, which hides broken contours from the renderer [px]; 0 for none.

        Returns:
            The sketch, and as holes what the bodies have left: there it shows what is known to be behind them.

        Raises:
            InvalidInputError: there is no such frame, or the blur is unusable.
        """
        require("frame", t, 0 <= t < len(self.flow), f"0 to {len(self.flow) - 1}")
        require("blur_sigma", blur_sigma, 0 <= blur_sigma <= 100, "0 to 100 px")
        lines, covered = 1 - self.still, np.zeros(self.still.shape, dtype=np.float32)
        for layer in self._layers:
            box, moved, opaque = layer.drawn(self.flow.motion, t)
            for plane, added in ((lines, moved), (covered, opaque)):
                part = plane[box.slices]
                part *= 1 - opaque
                part += added
        result = np.clip(1 - lines, 0, 1)
        if blur_sigma > 0:
            result = cv2.GaussianBlur(result, (0, 0), blur_sigma, borderType=cv2.BORDER_REPLICATE)
        return WarpedSketch(result, self._bared & (covered < 0.5))


@dataclass(frozen=True, eq=False)
class _LineLayer:
    """The lines of one body.

    Attributes:
        body: its number in the motion.
        mesh: its mesh, with an apron for the lines that stand out of it.
        canvas: the pixels of the texture; may exceed the picture.
        texture: lines, and where the body is opaque, at rest, shape [canvas height, canvas width, 2].
    """

    body: int
    mesh: ApronedMesh
    canvas: PixelBox
    texture: FloatImage

    @classmethod
    def cut(
        cls, lines: FloatImage, owned: Mask, flow: FlowSequence, body: int, *, hidden: FloatImage | None = None
    ) -> _LineLayer:
        """The layer of a body from all lines and the pixels whose lines it owns, shape [h, w] each.

        Args:
            lines: of the drawing.
            owned: where they are the body's.
            flow: of the motion.
            body: its number.
            hidden: the body's own lines, also those that something in front hides; None where they are not known.
        """
        mesh = flow.motion.bodies[body].mesh
        whole = PixelBox(0, 0, mesh.width, mesh.height)
        opaque = owned | (triangle_ids(mesh.vertices, mesh.triangles, whole) >= 0)
        canvas = canvas_of(mesh, reach=_REACH)
        rest = np.float32(0) if hidden is None else np.where(opaque, hidden, np.float32(0))
        texture = on_canvas(np.dstack([np.where(owned, lines, rest), opaque]).astype(np.float32), canvas)
        return cls(body, ApronedMesh.around(mesh, texture[..., 1], canvas, reach=_REACH), canvas, texture)

    def drawn(self, motion: Motion, t: int) -> tuple[PixelBox, FloatImage, FloatImage]:
        """Where the layer shows in a frame, its lines there, and how opaque it is, shape [box height, box width]."""
        points = self.mesh.positions(motion.of_body(self.body)[t])
        box = bounding_box(points, margin=1).clipped(motion.width, motion.height)
        if not (box.width and box.height):
            return box, *np.zeros((2, box.height, box.width), dtype=np.float32)
        x, y = self.mesh.places_at_rest(points, box, self.canvas)
        drawn = cv2.remap(self.texture, x, y, cv2.INTER_CUBIC, borderMode=cv2.BORDER_CONSTANT, borderValue=0)
        moved, opaque = cv2.split(np.clip(drawn, 0, 1))
        cover = motion.bodies[self.body].cover
        if cover is not None:
            seen = ~cover[box.slices]
            moved, opaque = moved * seen, opaque * seen
        return box, moved, opaque


def _owner(flow: FlowSequence, lines: FloatImage, order: list[int], border: int) -> NDArray[np.int32]:
    """The body that each pixel of the sketch belongs to, -1 for none, int32, shape [h, w].

    A contour is drawn around the body and half of it lies outside the mesh. So lines in the border belong to what they
    are connected with: to a body, or to still lines beyond the border, whichever is nearer along the lines.
    """
    still = len(order) + 1
    rank = np.zeros(still, dtype=np.uint16)
    rank[order] = np.arange(1, still)
    owner = np.where(flow.body >= 0, rank[flow.body], np.uint16(0))
    drawn, nearby = lines > _FAINT, np.ones((3, 3), np.uint8)
    near = cv2.dilate((owner > 0).astype(np.uint8), np.ones((2 * border + 1,) * 2, np.uint8)) > 0
    owner[drawn & ~near] = still
    for _ in range(border):
        owner = np.where((owner == 0) & drawn, cv2.dilate(owner, nearby), owner)
    return np.array([-1, *order, -1], dtype=np.int32)[owner]
