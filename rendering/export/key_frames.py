"""Few key frames in place of all: what lies between them is found again by straight lines."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["key_frames", "straight_error"]

FloatArray = NDArray[np.float64]


def key_frames(positions: NDArray[np.floating], keys: NDArray[np.floating], *, tolerance: float) -> list[int]:
    """Frames between which every vertex goes straight, up to a tolerance.

    Source: Ramer (1972), Douglas and Peucker (1973), with all vertices at once.

    Args:
        positions: where the vertices are, shape [frames, v, 2] [px].
        keys: where they are in a frame that is kept, as it will be written, of the same shape.
        tolerance: how far a vertex may ever be from where it was [px].

    Returns:
        Numbers of the frames, increasing, the first and the last among them; the first alone where nothing moves.
    """
    last = len(positions) - 1
    if not last or straight_error(positions, np.repeat(keys[:1], last + 1, axis=0)) <= tolerance:
        return [0]
    kept, open_parts = {0, last}, [(0, last)]
    while open_parts:
        begin, end = open_parts.pop()
        if end - begin < 2:
            continue
        share = (np.arange(begin + 1, end) - begin) / (end - begin)
        between = keys[begin] + share[:, None, None] * (keys[end] - keys[begin])
        apart = np.linalg.norm(positions[begin + 1 : end] - between, axis=2).max(axis=1)
        worst = int(apart.argmax())
        if apart[worst] > tolerance:
            middle = begin + 1 + worst
            kept.add(middle)
            open_parts += [(begin, middle), (middle, end)]
    return sorted(kept)


def straight_error(positions: NDArray[np.floating], other: NDArray[np.floating]) -> float:
    """How far any vertex is from where it should be in any frame [px]."""
    return float(np.linalg.norm(positions - other, axis=2).max(initial=0.0))
