"""Peaks of a sequence of numbers that stand out: without SciPy's ``signal``, whose import takes half a second."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["prominent_peaks"]


def prominent_peaks(values: NDArray[np.float64], prominence: float) -> NDArray[np.intp]:
    """Where a sequence has peaks that stand out, increasing; of a level top its middle. Neither end is a peak.

    Args:
        values: finite, shape [n].
        prominence: how far one has to come down from a peak, at least, on both sides, before it goes higher up.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.peaks import prominent_peaks
        >>> prominent_peaks(np.array([0.0, 5.0, 1.0, 1.5, 1.0, 4.0, 4.0, 4.0, 0.0]), 1.0).tolist()
        [1, 6]
    """
    changes = np.flatnonzero(np.diff(values))  # a level part goes from behind one of these to the next
    rises = values[changes + 1] > values[changes]
    tops = np.flatnonzero(rises[:-1] & ~rises[1:])
    found = (changes[tops] + 1 + changes[tops + 1]) // 2
    standing = [peak for peak in found if _prominence(values, int(peak)) >= prominence]
    return np.array(standing, dtype=np.intp)


def _prominence(values: NDArray[np.float64], peak: int) -> float:
    """How far one has to come down from a peak before it goes higher up, or the sequence ends."""
    higher = np.flatnonzero(values > values[peak])
    before, after = higher[higher < peak], higher[higher > peak]
    left = values[before[-1] + 1 if len(before) else 0 : peak + 1].min()
    right = values[peak : after[0] if len(after) else len(values)].min()
    return float(values[peak] - max(left, right))
