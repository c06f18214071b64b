"""What is asked of a segmentation: points on and beside an object, and a box around it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..physics.errors import InvalidInputError, require

__all__ = ["Box", "checked_box", "checked_points"]

Box = tuple[float, float, float, float]
"""x0, y0, x1, y1 [px]."""


def checked_points(
    points: ArrayLike, labels: ArrayLike, width: int, height: int
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """The points within the picture, and which of them are positive.

    Args:
        points: x and y of each point [px], shape [k, 2].
        labels: 1 for a point on the object, 0 for one beside it, shape [k].
        width: of the picture [px].
        height: of the picture [px].

    Raises:
        InvalidInputError: a point outside the picture, a label too many or too few, or points that contradict.
    """
    seeds = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    positive = np.asarray(labels).reshape(-1).astype(bool)
    require("labels", f"{len(positive)}", len(positive) == len(seeds), f"one per point ({len(seeds)})")
    for index, (x, y) in enumerate(seeds):
        if not (0 <= x <= width and 0 <= y <= height):
            raise InvalidInputError(
                f"points[{index}] must lie inside the picture of {width} x {height} px. Got: ({x:g}, {y:g})"
            )
    seeds = np.minimum(seeds, np.array([width, height]) - 0.5)
    cells = [tuple(cell) for cell in seeds.astype(int)]
    clash = {c for c, p in zip(cells, positive, strict=True) if p} & {
        c for c, p in zip(cells, positive, strict=True) if not p
    }
    require("points", sorted(clash), not clash, "either positive or negative, not both at one pixel")
    return seeds, positive


def checked_box(box: Box, width: int, height: int) -> Box:
    """The box within the picture.

    Raises:
        InvalidInputError: it has no area there.
    """
    x0, y0, x1, y1 = box
    inside = max(x0, 0) < min(x1, width) and max(y0, 0) < min(y1, height)
    require("box", box, inside, f"x0, y0, x1, y1 with an area inside the picture of {width} x {height} px")
    return max(x0, 0.0), max(y0, 0.0), min(x1, float(width)), min(y1, float(height))
