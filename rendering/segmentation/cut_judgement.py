"""Whether a mask that was cut from points can be what was meant, in sentences for the person who clicked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.document import parse_points
from ...physics.mesh import SMALLEST_PART, largest_area
from .parts_beyond import parts_beyond
from .prompts import Box, Prompt
from .speck_clicks import REACH

__all__ = ["judge_cut", "judge_cuts", "judge_points"]

Mask = NDArray[np.bool_]

# Of the picture: a hundredth of a percent is 9 x 10 px of 1280 x 720, less than what is worth moving.
_SPECK = 1e-4
_LARGEST = 0.5


def judge_cut(
    mask: Mask,
    points: ArrayLike,
    labels: ArrayLike,
    *,
    box: Box | None = None,
    image: NDArray[Any] | None = None,
    others: Mask | None = None,
) -> list[str]:
    """What is suspicious about a mask, given the points that it was cut from.

    Args:
        mask: shape [h, w].
        points: x and y of each point [px], shape [k, 2].
        labels: 1 for a point on the object, 0 for one beside it, shape [k].
        box: x0, y0, x1, y1 [px] around the object, where one was given.
        image: what it was cut from, RGB, shape [h, w, 3]; without it nothing is said of what lies across a strap.
        others: what belongs to other parts, shape [h, w].

    Returns:
        Sentences, each with what to do; none where nothing is suspicious.
    """
    mask = np.asarray(mask, dtype=bool)
    height, width = mask.shape
    if not mask.any():
        return ["Nothing was cut: put points on the middle of what shall move, or draw a box around it."]
    cells = np.asarray(points, np.float64).reshape(-1, 2).astype(int)
    cells = np.clip(cells, 0, (width - 1, height - 1))
    positive = np.asarray(labels).reshape(-1).astype(bool)
    found = [_specks(mask, cells[positive]), _holes(mask, cells[~positive])]
    share = float(mask.mean())
    if share > _LARGEST and box is None and positive.sum() == 1:
        found.append(
            f"The cut is {100 * share:.0f} % of the picture from one point, most likely the background too: put points"
            " beside it (Alt+click, or 0 in a list) on what shall stay, or draw a box around what shall move."
        )
    if image is not None and not any(found) and box is None:
        found.append(_across(image, mask, cells[~positive], others))
    if not any(found) and (area := largest_area(mask)) < SMALLEST_PART:
        found.append(f"The cut is too small to move, {area} px: put more points on the part, or draw a larger box.")
    return [each for each in found if each]


def judge_cuts(
    masks: Sequence[Mask], prompts: Sequence[Prompt], *, instead: str = "", image: NDArray[Any] | None = None
) -> list[str]:
    """What is suspicious about the masks of several parts.

    Args:
        masks: shape [h, w] each.
        prompts: what was asked for, in the same order.
        instead: what else cuts, named where anything is suspicious: a sentence.
        image: what they were cut from, RGB, shape [h, w, 3]; see ``judge_cut``.

    Returns:
        Sentences, with the part's name where there are several, or else its number, counted from 1.
    """
    told = []
    for number, (mask, prompt) in enumerate(zip(masks, prompts, strict=True)):
        part = f"{prompt.name or f'Part {number + 1}'}: " if len(masks) > 1 else ""
        rest = [other for index, other in enumerate(masks) if index != number]
        others = np.logical_or.reduce(rest) if rest else None
        said = judge_cut(mask, prompt.points, prompt.labels, box=prompt.box, image=image, others=others)
        told += [part + each for each in said]
    return [*told, instead] if told and instead else told


def judge_points(
    masks: Sequence[Mask], points: Sequence[Any], names: Sequence[str] = (), *, image: NDArray[Any] | None = None
) -> list[str]:
    """What is suspicious about masks that were cut each from points as they are read.

    Args:
        masks: shape [h, w] each.
        points: for each mask what ``parse_points`` reads.
        names: what sentences call the masks; their numbers, counted from 1, if left out.
        image: what they were cut from, RGB, shape [h, w, 3]; see ``judge_cut``.

    Returns:
        Sentences, with the mask's name where there are several.
    """
    prompts = []
    for mask, given, name in zip(masks, points, names or [""] * len(masks), strict=True):
        clicked = parse_points(given, width=mask.shape[1], height=mask.shape[0])
        prompts.append(Prompt([(each.x, each.y) for each in clicked], [each.positive for each in clicked], None, name))
    return judge_cuts(masks, prompts, image=image)


def _across(image: NDArray[Any], mask: Mask, beside: NDArray[np.int_], others: Mask | None) -> str:
    """About what looks like the part on the other side of something narrow, such as a strap."""
    found = parts_beyond(image, mask, beside=beside)
    if others is not None:
        found = [each for each in found if not others[each.y, each.x]]
    if not found:
        return ""
    places = ", ".join(f"({each.x}, {each.y})" for each in found[:3]) + (", ..." if len(found) > 3 else "")
    return (
        f"The cut ends at something narrow, and its colours go on beyond it, at {places}: {found[0].area} px that stay"
        " still. If they belong to the part, put a point on them; if not, one beside the part (Alt+click, or"
        " 0 in a list)."
    )


def _specks(mask: Mask, cells: NDArray[np.int_]) -> str:
    """About the points on the part around which hardly anything was cut."""
    _, labels, statistics, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    areas = np.array([_area_near(cell, labels, statistics[:, cv2.CC_STAT_AREA]) for cell in cells], dtype=int)
    small = areas <= max(1.0, _SPECK * mask.size)
    if not small.any():
        return ""
    what, itself = "The point on the part", "itself"
    if len(cells) > 1:
        what = f"{small.sum()} of {len(cells)} points on the part"
        itself = "itself" if small.sum() == 1 else "themselves"
    places = ", ".join(f"({x}, {y})" for x, y in cells[small][:3]) + (", ..." if small.sum() > 3 else "")
    return (
        f"{what} cut out hardly more than {itself}, at {places}: {int(areas[small].max())} px at most. Put points"
        " off lines and edges, more of them on other colours of the part, or draw a box around it."
    )


def _area_near(cell: NDArray[np.int_], labels: NDArray[np.int32], areas: NDArray[np.int32]) -> int:
    """The largest piece of a cut within the reach in which a click stands for what is close by [px]."""
    reach = round(REACH * max(labels.shape))
    x, y = np.maximum(cell - reach, 0)
    near = np.unique(labels[y : cell[1] + reach + 1, x : cell[0] + reach + 1])
    return int(areas[near[near > 0]].max(initial=0))


def _holes(mask: Mask, cells: NDArray[np.int_]) -> str:
    """About the points beside the part that the cut surrounds, as if they had not been said."""
    padded = np.pad(mask, 1)
    rings = [padded[y : y + 3, x : x + 3].sum() - mask[y, x] for x, y in cells]
    inside = np.array([ring == 8 or mask[y, x] for ring, (x, y) in zip(rings, cells, strict=True)], dtype=bool)
    if not inside.any():
        return ""
    places = ", ".join(f"({x}, {y})" for x, y in cells[inside][:3]) + (", ..." if inside.sum() > 3 else "")
    return (
        f"The cut goes around {inside.sum()} of {len(cells)} points beside the part, at {places}: put more points"
        " beside the part (Alt+click, or 0 in a list) there, or draw a box around the part."
    )
