"""Points of a picture: what strokes and rig points are drawn with."""

from __future__ import annotations

from collections.abc import Iterable

from .errors import require
from .limits import LARGEST, MAX_POINTS

__all__ = ["Point", "Scale", "checked_points", "scaled_points"]

Point = tuple[float, float]
"""x and y [px]."""

Scale = tuple[float, float, float]
"""Factors on x, on y and on lengths, from one size of the picture to another."""


def checked_points(name: str, points: Iterable[Point], *, least: int) -> tuple[Point, ...]:
    """Points as pairs of floats.

    Args:
        name: what the user calls the points.
        points: [px].
        least: how many there must be.

    Raises:
        InvalidInputError: they are too few or too many, not finite or very far away.
    """
    points = tuple((float(x), float(y)) for x, y in points)
    require(name, f"{len(points)}", len(points) >= least, f"at least {least} point{'s' * (least > 1)}")
    require(name, f"{len(points)}", len(points) <= MAX_POINTS, f"at most {MAX_POINTS} points")
    far = [point for point in points if not (abs(point[0]) <= LARGEST and abs(point[1]) <= LARGEST)]
    require(name, far[:1], not far, f"pixel coordinates from -{LARGEST} to {LARGEST}")
    return points


def scaled_points(points: Iterable[Point], scale: Scale) -> tuple[Point, ...]:
    """The same points over the picture at another size."""
    return tuple((x * scale[0], y * scale[1]) for x, y in points)
