"""Sketches of all frames of a motion, in any of the ways of warping them (paper, Method, "Sketch-Guided Rendering")."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Literal, get_args

from numpy.typing import NDArray

from ...physics.errors import require
from ...physics.motion import FlowSequence
from .layered_sketch import LayeredSketch
from .warp import WarpedSketch, warp_sketch

__all__ = ["WARP_MODES", "WarpMode", "warped_sketches"]

WarpMode = Literal["layered", "paper", "softmax"]
WARP_MODES: tuple[WarpMode, ...] = get_args(WarpMode)


def warped_sketches(
    sketch: NDArray[Any],
    flow: FlowSequence,
    frames: Iterable[int] | None = None,
    *,
    mode: WarpMode = "layered",
    behind: NDArray[Any] | None = None,
    own: Sequence[NDArray[Any]] | None = None,
    blur_sigma: float = 0.8,
) -> Iterator[WarpedSketch]:
    """The sketch of one frame after the other.

    Args:
        sketch: of the drawing, paper 1, lines 0, shape [h, w].
        flow: of the motion.
        frames: numbers of the frames; all when None.
        mode: "layered" moves the lines of each body with its mesh and lays them over the still ones in depth order;
            "paper" and "softmax" splat all pixels, see :func:`~physanimator.rendering.sketch.warp_sketch`.
        behind: sketch of what is behind the bodies, which shows where they leave; only "layered" can use it.
        own: sketch of each body's own layer, see :class:`LayeredSketch`; only "layered" can use them.
        blur_sigma: Gaussian blur of the result [px]; 0 for none.

    Raises:
        InvalidInputError: sizes differ or a parameter is unusable.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import FlowSequence, Motion
        >>> from physanimator.physics.scene import Body
        >>> from physanimator.rendering.sketch import warped_sketches
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> sketch = np.ones((60, 60), np.float32)
        >>> sketch[:, 30] = 0
        >>> [int(np.argmin(each.sketch[30])) for each in warped_sketches(sketch, FlowSequence(motion))]
        [30, 33]
    """
    require("mode", mode, mode in WARP_MODES, f"one of {', '.join(WARP_MODES)}")
    wanted = range(len(flow)) if frames is None else frames
    if mode == "layered":
        layers = LayeredSketch(sketch, flow, behind=behind, own=own)
        return (layers.frame(t, blur_sigma=blur_sigma) for t in wanted)
    require("behind", "a sketch", behind is None, "left out unless mode is layered")
    require("own", "sketches", own is None, "left out unless mode is layered")
    return (warp_sketch(sketch, flow.flow(t), mode=mode, blur_sigma=blur_sigma) for t in wanted)
