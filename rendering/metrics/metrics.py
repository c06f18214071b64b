"""How good a clip is, in numbers that need no network: steady, still where it should be, true to its sketches, moving.

Each measure is fed the frames one after the other, so that a long clip is never held at once.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, require
from ...physics.motion import Motion
from ...physics.progress import Progress
from ..pictures import as_float, as_picture
from ..sketch import extract_sketch
from .dynamic_degree import DynamicDegree
from .flow_warp_error import FlowWarpError, RestMaps
from .sketch_distance import chamfer_distance
from .static_drift import StaticDrift, still_region

__all__ = ["ClipMetrics", "hole_ratio", "measure_clip"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class ClipMetrics:
    """The measures of a clip; None where a clip or its inputs do not allow one.

    Attributes:
        flow_warp_error: mean change of colour on the bodies from frame to frame, followed along the simulation's own
            flow, 0..1; lower is steadier.
        flow_warp_error_to_first: the same between each frame and the first, 0..1; lower keeps the drawing better.
        static_drift: mean change of colour where no body ever comes, against the drawing, 0..1.
        worst_static_drift: that of the worst frame, 0..1.
        sketch_adherence: mean Chamfer distance between the lines of the frames and the driving sketches [px].
        dynamic_degree: mean over the frames of the optical flow that is seen in the 5 % that move most [px/frame].
        hole_ratio: mean share of the picture that the bodies have left, of which nothing is known, 0..1.
    """

    flow_warp_error: float | None
    flow_warp_error_to_first: float | None
    static_drift: float | None
    worst_static_drift: float | None
    sketch_adherence: float | None
    dynamic_degree: float | None
    hole_ratio: float

    def as_dict(self) -> dict[str, float | None]:
        """The measures by name."""
        return asdict(self)


def measure_clip(
    frames: Iterable[NDArray[Any]],
    motion: Motion,
    *,
    drawing: NDArray[Any] | None = None,
    sketches: Iterable[NDArray[Any]] | None = None,
    progress: Progress | None = None,
) -> ClipMetrics:
    """Measure a clip of a motion.

    Args:
        frames: one for each frame of the motion, RGB, uint8 or float32 in 0..1, shape [h, w, 3].
        motion: what the clip shows.
        drawing: the illustration, for the drift; the first frame when None.
        sketches: that drove the clip, one for each frame, paper 1, lines 0, shape [h, w]; without them there is no
            adherence.
        progress: called after each frame.

    Raises:
        InvalidInputError: sizes or numbers do not fit together.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion
        >>> from physanimator.physics.scene import Body
        >>> from physanimator.rendering.metrics import measure_clip
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> measured = measure_clip([picture, picture], motion)
        >>> measured.hole_ratio > 0, measured.as_dict()["dynamic_degree"]
        (True, 0.0)
    """
    count = len(motion)
    driving = None if sketches is None else iter(sketches)
    maps = RestMaps(motion)
    reference = None if drawing is None else _checked(drawing, motion)
    errors, degree, drift, distances = FlowWarpError(maps), DynamicDegree(), None, []
    done = 0
    for done, each in enumerate(frames, start=1):
        require("frames", f"at least {done}", done <= count, f"one for each of the motion's {count} frames")
        frame = _checked(each, motion)
        if drift is None:
            drift = StaticDrift(frame if reference is None else reference, still_region(maps))
        errors.add(frame)
        drift.add(frame)
        degree.add(frame)
        if driving is not None:
            sketch = next(driving, None)
            require("sketches", done - 1, sketch is not None, f"one for each of {count} frames")
            distances.append(chamfer_distance(extract_sketch(frame), np.asarray(sketch)))
        if progress is not None:
            progress(done, count)
    require("frames", done, done == count, f"one for each of the motion's {count} frames")
    assert drift is not None
    return ClipMetrics(
        errors.to_previous,
        errors.to_first,
        drift.mean,
        drift.worst,
        float(np.mean(distances)) if distances else None,
        degree.value,
        hole_ratio(maps),
    )


def hole_ratio(maps: RestMaps) -> float:
    """Mean share of the picture that bodies cover in the drawing and have left in a frame, 0..1."""
    inside = maps.flow.inside
    left = [np.count_nonzero(inside & ~maps.covered(t)) for t in range(len(maps.flow))]
    return float(np.mean(left)) / inside.size


def _checked(frame: NDArray[Any], motion: Motion) -> FloatImage:
    frame = as_picture(frame, name="frames")
    if frame.shape[:2] != (motion.height, motion.width):
        raise InvalidInputError(
            f"frames must have the motion's size, {motion.width} x {motion.height} px."
            f" Got: {frame.shape[1]} x {frame.shape[0]} px"
        )
    return as_float(frame)
