"""What is asked of a segmentation: points on and beside an object, and a box around it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.document import require_pixels
from ...physics.errors import InvalidInputError, counted, require
from ...physics.scene import QueryPoint

__all__ = ["Box", "Prompt", "checked_box", "checked_points", "prompts_of", "require_object"]

Box = tuple[float, float, float, float]
"""x0, y0, x1, y1 [px]."""


@dataclass(frozen=True, eq=False)
class Prompt:
    """What is said about one object.

    Attributes:
        points: x and y [px], shape [k, 2]; may be empty if there is a box.
        labels: 1 for a point on the object, 0 for one beside it, shape [k].
        box: x0, y0, x1, y1 [px] around the object.
        name: what sentences call the object; empty where there is only one.
    """

    points: ArrayLike = field(default_factory=lambda: np.zeros((0, 2)))
    labels: ArrayLike = ()
    box: Box | None = None
    name: str = ""


def require_object(positive: NDArray[np.bool_], box: Box | None) -> None:
    """Refuse a prompt that says only what is beside the object.

    Args:
        positive: whether each point is on the object, shape [k].
        box: around the object, where one was given.

    Raises:
        InvalidInputError: no point is on the object, and there is no box.
    """
    got = f"{counted(len(positive), 'point')}, all beside it" if len(positive) else "no points"
    require("points", got, bool(positive.any()) or box is not None, "with one on the part at least, or with a box")


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
        InvalidInputError: a point outside the picture, all within its first pixel as normalised ones are, a label too
            many or too few, or points that contradict.
    """
    seeds = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    positive = np.asarray(labels).reshape(-1).astype(bool)
    require("labels", f"{len(positive)}", len(positive) == len(seeds), f"one per point ({len(seeds)})")
    for index, (x, y) in enumerate(seeds):
        if not (0 <= x <= width and 0 <= y <= height):
            raise InvalidInputError(
                f"points[{index}] must lie inside the picture of {width} x {height} px. Got: ({x:g}, {y:g})"
            )
    if max(width, height) > 1:
        require_pixels("points", [(float(x), float(y)) for x, y in seeds])
    seeds = np.minimum(seeds, np.array([width, height]) - 0.5)
    cells = [tuple(cell) for cell in seeds.astype(int).tolist()]
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


def prompts_of(points: Sequence[QueryPoint], boxes: Sequence[Box] = ()) -> list[Prompt]:
    """One prompt for each part that has a point or a box, in the order of their numbers.

    Args:
        points: with the number of the part that each is about.
        boxes: of part 0, part 1 and so on; may be fewer than the parts.

    Raises:
        InvalidInputError: there is neither a point nor a box.
    """
    parts = sorted({point.part for point in points} | set(range(len(boxes))))
    require("points", "none", bool(parts), "at least one point, or a box")
    prompts = []
    for part in parts:
        own = [point for point in points if point.part == part]
        box = boxes[part] if part < len(boxes) else None
        name = f"Part {part + 1}" if len(parts) > 1 else ""
        prompts.append(Prompt([(each.x, each.y) for each in own], [each.positive for each in own], box, name))
    return prompts
