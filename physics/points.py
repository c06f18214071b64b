"""Points of a picture: what strokes and rig points are drawn with."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from .checks import numbers_of
from .errors import InvalidInputError, counted, require
from .fields import Field
from .limits import LARGEST, MAX_POINTS

__all__ = ["Point", "Scale", "checked_pair", "checked_points", "point_field", "points_field", "scaled_points"]

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
    if not isinstance(points, Iterable) or isinstance(points, str | bytes | dict):
        raise InvalidInputError(f"{name} must be points, each an x and a y [px]. Got: {points!r:.60}")
    points = tuple(checked_pair(name, point) for point in points)
    require(name, f"{len(points)}", len(points) >= least, f"at least {least} point{'s' * (least > 1)}")
    require(name, f"{len(points)}", len(points) <= MAX_POINTS, f"at most {MAX_POINTS} points")
    far = [point for point in points if not (abs(point[0]) <= LARGEST and abs(point[1]) <= LARGEST)]
    require(name, far[:1], not far, f"pixel coordinates from -{LARGEST} to {LARGEST}")
    return points


def points_field(title: str, about: str, *, least: int) -> Field:
    """A field that holds points [px], at least so many."""
    check = partial(checked_points, least=least)
    return Field(title, about, "px", entry="point", least=least, most=MAX_POINTS, check=check)


def point_field(title: str, about: str) -> Field:
    """A field that holds a point [px]."""
    return Field(
        title, about, "px", entry="point", check=lambda name, point: checked_points(name, (point,), least=1)[0]
    )


def checked_pair(name: str, pair: object) -> Point:
    """Two numbers as floats.

    Args:
        name: what the user calls them.
        pair: the numbers.

    Raises:
        InvalidInputError: they are no two numbers.
    """
    found = numbers_of(name, pair, "two numbers, x and y")
    require(name, counted(len(found), "number"), len(found) == 2, "two numbers, x and y")
    return found[0], found[1]


def scaled_points(points: Iterable[Point], scale: Scale) -> tuple[Point, ...]:
    """The same points over the picture at another size."""
    return tuple((x * scale[0], y * scale[1]) for x, y in points)
