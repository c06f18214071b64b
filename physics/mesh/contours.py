"""Closed contours of a soft mask at sub-pixel accuracy, their smoothing, and their sampling by arc length."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

__all__ = ["area_of", "contours_at_half", "perimeter_of", "resampled", "smoothed"]

FloatArray = NDArray[np.float64]
_FEWEST_POINTS = 3
_SMOOTHING_STEP = 0.5
# Crossings keep this far from pixel centres, so that no two of them coincide.
_NEAREST_CROSSING = 0.02

_TOP, _RIGHT, _BOTTOM, _LEFT = range(4)
# Segments (from side, to side) of a marching-squares cell by the code of its inside corners
# (1 upper left, 2 upper right, 4 lower right, 8 lower left); the inside is always on the same hand.
_SEGMENTS: dict[int, tuple[tuple[int, int], ...]] = {
    1: ((_LEFT, _TOP),),
    2: ((_TOP, _RIGHT),),
    3: ((_LEFT, _RIGHT),),
    4: ((_RIGHT, _BOTTOM),),
    5: ((_LEFT, _TOP), (_RIGHT, _BOTTOM)),
    6: ((_TOP, _BOTTOM),),
    7: ((_LEFT, _BOTTOM),),
    8: ((_BOTTOM, _LEFT),),
    9: ((_BOTTOM, _TOP),),
    10: ((_TOP, _RIGHT), (_BOTTOM, _LEFT)),
    11: ((_BOTTOM, _RIGHT),),
    12: ((_RIGHT, _LEFT),),
    13: ((_RIGHT, _TOP),),
    14: ((_TOP, _LEFT),),
}


def contours_at_half(coverage: NDArray[np.float32]) -> list[FloatArray]:
    """Closed curves along which a soft mask passes one half (marching squares).

    No curve touches itself or another one: pixels that meet only at a corner are apart.

    Args:
        coverage: soft mask in 0 to 1, shape [h, w]; its outermost pixels must be at most one half.

    Returns:
        One array of points [px] a curve, shape [n, 2], without repeating the first point. Pixel centres lie at
        integer + 0.5. Outer curves have negative ``area_of``, those around holes positive, as the
        boundary of a TriangleMesh has.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import area_of, contours_at_half
        >>> round(abs(area_of(contours_at_half(np.pad(np.ones((8, 8), np.float32), 2))[0])))
        64
    """
    columns = coverage.shape[1]
    inside = coverage > 0.5
    corner = inside.astype(np.int8)
    code = corner[:-1, :-1] + 2 * corner[:-1, 1:] + 4 * corner[1:, 1:] + 8 * corner[1:, :-1]
    row, column = np.nonzero((code > 0) & (code < 15))
    code = code[row, column]
    upper_left = row * columns + column
    # A crossing is known by the pixel to its left or above, those on vertical pairs after those on horizontal pairs.
    side = {_TOP: upper_left, _BOTTOM: upper_left + columns}
    side |= {_LEFT: upper_left + inside.size, _RIGHT: upper_left + inside.size + 1}
    start, end = [], []
    for corners, segments in _SEGMENTS.items():
        here = code == corners
        start += [side[first][here] for first, _ in segments]
        end += [side[last][here] for _, last in segments]
    crossing, follower = np.concatenate(start), np.concatenate(end)
    order = np.argsort(crossing)
    crossing, follower = crossing[order], follower[order]
    points = _crossing_points(coverage, crossing)
    return [points[cycle] for cycle in _cycles(np.searchsorted(crossing, follower).tolist())]


def area_of(loop: FloatArray) -> float:
    """Signed shoelace area of a closed polygon on y-down coordinates [px^2]."""
    x, y = (loop - loop[0]).T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def perimeter_of(loop: FloatArray) -> float:
    """Length of a closed polygon [px]."""
    return float(np.hypot(*(np.roll(loop, -1, axis=0) - loop).T).sum())


def resampled(loop: FloatArray, spacing: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Points along a closed polygon, evenly spaced by arc length in units of the local spacing.

    Where the spacing is the same everywhere, the points are equidistant along the polygon.

    Args:
        loop: closed polygon [px], shape [n, 2].
        spacing: wanted distance [px] at points [px], shape [n, 2] -> [n].

    Returns:
        At least three points on the polygon [px], shape [m, 2].
    """
    closed = np.concatenate([loop, loop[:1]])
    steps = np.hypot(*np.diff(closed, axis=0).T)
    density = 1.0 / spacing(closed)
    travelled = np.concatenate([[0.0], np.cumsum(steps * 0.5 * (density[1:] + density[:-1]))])
    count = max(_FEWEST_POINTS, round(travelled[-1]))
    at = travelled[-1] / count * np.arange(count)
    return np.stack([np.interp(at, travelled, closed[:, axis]) for axis in (0, 1)], axis=1)


def smoothed(loop: FloatArray, scale: float) -> FloatArray:
    """A closed polygon without pixel jags: averaged along itself with a Gaussian.

    Args:
        loop: closed polygon [px], shape [n, 2].
        scale: standard deviation of the Gaussian along the polygon [px].

    Returns:
        Closed polygon [px] of points about half a pixel apart, shape [m, 2].
    """
    length = perimeter_of(loop)
    count = max(16, round(length / _SMOOTHING_STEP))
    even = resampled(loop, lambda points: np.full(len(points), length / count))
    frequency = np.fft.rfftfreq(len(even), length / len(even))
    kept = np.exp(-2 * (np.pi * scale * frequency) ** 2)
    return np.fft.irfft(np.fft.rfft(even, axis=0) * kept[:, None], n=len(even), axis=0)


def _crossing_points(coverage: NDArray[np.float32], crossing: NDArray[np.int64]) -> FloatArray:
    """Where the soft mask passes one half between neighbouring pixel centres [px], shape [n, 2]."""
    down, pixel = np.divmod(crossing, coverage.size)
    row, column = np.divmod(pixel, coverage.shape[1])
    first = coverage[row, column].astype(np.float64)
    second = coverage[row + down, column + 1 - down].astype(np.float64)
    along = np.clip((0.5 - first) / (second - first), _NEAREST_CROSSING, 1 - _NEAREST_CROSSING)
    return np.stack([column + 0.5 + along * (1 - down), row + 0.5 + along * down], axis=1)


def _cycles(follower: list[int]) -> list[list[int]]:
    """The cycles of a permutation, each as the list of its members in order."""
    seen = bytearray(len(follower))
    cycles = []
    for start in range(len(follower)):
        cycle = []
        at = start
        while not seen[at]:
            seen[at] = 1
            cycle.append(at)
            at = follower[at]
        if cycle:
            cycles.append(cycle)
    return cycles
