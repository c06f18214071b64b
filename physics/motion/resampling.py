"""A motion at times between its frames."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

__all__ = ["INTERPOLATIONS", "Interpolation", "frame_at", "sample_times"]

Interpolation = Literal["linear", "cubic"]
INTERPOLATIONS: tuple[Interpolation, ...] = get_args(Interpolation)


def sample_times(frames: int, samples: int) -> NDArray[np.float64]:
    """Times, in frames, that divide a clip from its first frame to its last evenly, shape [samples].

    Args:
        frames: frames of the clip.
        samples: how many times.
    """
    return np.linspace(0.0, frames - 1, samples)


def frame_at(positions: NDArray[np.floating], time: float, interpolation: Interpolation) -> NDArray[np.float64]:
    """Positions at a time between frames.

    Args:
        positions: at each frame, shape [f, v, 2].
        time: in frames, from 0 to f - 1; at whole numbers the result is that frame.
        interpolation: straight from frame to frame, or along a Catmull-Rom curve, which keeps the speed steady.

    Returns:
        Positions, shape [v, 2].
    """
    last = len(positions) - 1
    before = min(int(time), last)
    u = time - before
    if u == 0:
        return positions[before].astype(np.float64)
    p1, p2 = positions[before].astype(np.float64), positions[before + 1].astype(np.float64)
    if interpolation == "linear":
        return (1 - u) * p1 + u * p2
    # Beyond the ends the motion goes on as it did.
    p0 = positions[before - 1] if before > 0 else 2 * p1 - p2
    p3 = positions[before + 2] if before + 2 <= last else 2 * p2 - p1
    return p1 + 0.5 * u * (p2 - p0 + u * (2 * p0 - 5 * p1 + 4 * p2 - p3 + u * (3 * (p1 - p2) + p3 - p0)))
