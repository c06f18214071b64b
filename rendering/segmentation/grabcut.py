"""Masks from a few clicks: GrabCut on flat-coloured art, seeded by the regions that the clicks fall into.

Drawn art is made of regions of slowly changing colour between outlines. Each query point therefore stands for the
whole region around it, which gives GrabCut (Rother, Kolmogorov and Blake, 2004) far better colour models than
the bare points would.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.errors import InvalidInputError
from ...physics.interruption import checkpoint
from ..pictures import as_picture, as_uint8
from ..sketch import extract_sketch
from .line_clicks import off_lines
from .noise import noise_of, without_noise
from .outline_cuts import cut_by_majority, grab_cut, window_of, without_foreign_lines
from .prompts import Box, checked_box, checked_points, require_object
from .speck_clicks import off_specks
from .trimap import trimap_from_points

__all__ = ["segment"]

Mask = NDArray[np.bool_]
Lab = NDArray[np.uint8]

# A part of a picture smaller than this may be a few pixels: too few to tell its colours, its lines and its edge apart.
_ENOUGH = 256
_LINE = 0.25  # a sketch is darker than this on a line, not on its soft rim


def segment(
    image: NDArray[Any],
    points: ArrayLike,
    labels: ArrayLike,
    *,
    box: Box | None = None,
    tolerance: int = 4,
    iterations: int = 3,
    largest_hole: float = 0.0005,
    working_size: int = 640,
) -> Mask:
    """The object on which the positive points lie.

    Every positive point is inside the mask and every negative point outside, whatever the colours say.

    Args:
        image: RGB, uint8 or float in 0..1, shape [h, w, 3].
        points: x and y of each point [px], shape [k, 2].
        labels: 1 for a point on the object, 0 for one beside it, shape [k].
        box: x0, y0, x1, y1 [px]; nothing outside it is selected. May replace the positive points.
        tolerance: how much colour may change from pixel to pixel within one region [8-bit Lab steps].
        iterations: rounds of GrabCut.
        largest_hole: gaps in the mask up to this share of the picture are closed, and islands without a point left out.
        working_size: longest side at which regions and colours are weighed [px].

    Returns:
        mask, bool, shape [h, w].

    Raises:
        InvalidInputError: no positive point and no box, a point outside the picture, or points that contradict.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.segmentation import segment
        >>> picture = np.full((300, 300, 3), 230, np.uint8)
        >>> picture[80:220, 90:210] = (200, 60, 40)
        >>> mask = segment(picture, points=[(150, 150), (20, 20)], labels=[1, 0])
        >>> mask[150, 150].item(), mask[20, 20].item()
        (True, False)
    """
    picture = _as_uint8(image)
    height, width = picture.shape[:2]
    seeds, positive = checked_points(points, labels, width, height)
    require_object(positive, box)
    if (factor := _ENOUGH // max(width, height)) > 1:
        options = {"tolerance": tolerance, "iterations": iterations, "largest_hole": largest_hole}
        return _enlarged(picture, seeds, positive, box, factor, options)
    limit = _box_mask(box, width, height)
    for index in np.flatnonzero(positive):
        x, y = seeds[index].astype(int)
        if not limit[y, x]:
            raise InvalidInputError(
                f"points[{index}] must lie inside the box {box}, for it is positive. Got: ({x}, {y})"
            )
    scale = min(1.0, working_size / max(width, height))
    small_size = (max(1, round(width * scale)), max(1, round(height * scale)))
    lab = cv2.cvtColor(cv2.resize(picture, small_size, interpolation=cv2.INTER_AREA), cv2.COLOR_RGB2Lab)
    small_limit = cv2.resize(limit.astype(np.uint8), small_size, interpolation=cv2.INTER_NEAREST) > 0
    at = np.minimum((seeds * small_size / (width, height)).astype(int), np.array(small_size) - 1)

    at, on_object = off_lines(lab, at, positive, tolerance)
    at = off_specks(lab, at, on_object, tolerance)
    trimap = trimap_from_points(lab, at, on_object, small_limit, tolerance, has_box=box is not None)
    # Noise stays: the colour models and the smoothness of the cut bear it better than the loss of thin strands.
    found = cut_by_majority(lab, trimap, iterations, at[on_object])
    checkpoint()
    mask = cv2.resize(found.astype(np.float32), (width, height), interpolation=cv2.INTER_LINEAR) > 0.5
    mask = _sharpened(picture, mask, reach=max(2, round(2 / scale)))
    mask = _with_outline(picture, mask) & limit
    cells = seeds.astype(int)
    mask = _without_crumbs(_filled(mask, largest_hole) & limit, largest_hole, cells[positive])
    return _honouring(mask, cells, positive)


def _as_uint8(image: NDArray[Any]) -> NDArray[np.uint8]:
    return np.ascontiguousarray(as_uint8(as_picture(image)))


def _enlarged(
    picture: NDArray[np.uint8],
    seeds: NDArray[np.float64],
    positive: NDArray[np.bool_],
    box: Box | None,
    factor: int,
    options: dict[str, Any],
) -> Mask:
    """The mask of a tiny picture, such as a sprite: cut with every pixel drawn as a square, and counted by squares."""
    large = picture.repeat(factor, axis=0).repeat(factor, axis=1)
    middles = (np.floor(seeds) + 0.5) * factor
    frame = None if box is None else (box[0] * factor, box[1] * factor, box[2] * factor, box[3] * factor)
    mask = segment(large, middles, positive, box=frame, **options)
    height, width = picture.shape[:2]
    squares = mask.reshape(height, factor, width, factor).mean(axis=(1, 3))
    return _honouring(squares > 0.5, seeds.astype(int), positive)


def _box_mask(box: Box | None, width: int, height: int) -> Mask:
    if box is None:
        return np.ones((height, width), dtype=bool)
    x0, y0, x1, y1 = checked_box(box, width, height)
    mask = np.zeros((height, width), dtype=bool)
    mask[int(y0) : int(np.ceil(y1)), int(x0) : int(np.ceil(x1))] = True
    return mask


def _sharpened(picture: NDArray[np.uint8], mask: Mask, *, reach: int) -> Mask:
    """The mask with its edge laid again at full resolution, within ``reach`` pixels of where it is."""
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
    core = cv2.erode(mask.astype(np.uint8), kernel, borderValue=1) > 0
    shell = cv2.dilate(mask.astype(np.uint8), kernel) > 0
    # Two rounds of dilation leave a rim of true background to learn from.
    rim = cv2.dilate(shell.astype(np.uint8), kernel, iterations=2) > 0
    trimap = np.full(mask.shape, cv2.GC_BGD, dtype=np.uint8)
    trimap[shell] = cv2.GC_PR_BGD
    trimap[mask] = cv2.GC_PR_FGD
    trimap[core] = cv2.GC_FGD
    rows, columns = window_of(rim, margin=0)
    lab = cv2.cvtColor(np.ascontiguousarray(picture[rows, columns]), cv2.COLOR_RGB2Lab)
    lab = without_noise(lab, noise_of(lab, core[rows, columns]))
    found = np.zeros(mask.shape, dtype=bool)
    found[rows, columns] = grab_cut(lab, trimap[rows, columns], 1)
    return found


def _with_outline(picture: NDArray[np.uint8], mask: Mask, *, widest: int = 2) -> Mask:
    """The mask with the drawn line around it, which belongs to the object, and without the lines of others."""
    if not mask.any():
        return mask
    rows, columns = window_of(mask, margin=4 * widest)
    lines = extract_sketch(np.ascontiguousarray(picture[rows, columns])) < _LINE
    grown = mask[rows, columns].astype(np.uint8)
    cross = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))
    for _ in range(widest):
        grown |= cv2.dilate(grown, cross) & lines
    result = mask.copy()
    result[rows, columns] = without_foreign_lines(grown > 0, lines, widest=widest)
    return result


def _without_crumbs(mask: Mask, least: float, cells: NDArray[np.int_]) -> Mask:
    """The mask without islands below a share of the picture on which there is no point."""
    _, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    keep = stats[:, cv2.CC_STAT_AREA] > least * mask.size
    keep[labels[cells[:, 1], cells[:, 0]]] = True
    return mask & keep[labels]


def _filled(mask: Mask, largest_hole: float) -> Mask:
    """The mask with its gaps up to a share of the picture closed."""
    _, labels, stats, _ = cv2.connectedComponentsWithStats((~mask).astype(np.uint8), connectivity=8)
    small = stats[:, cv2.CC_STAT_AREA] <= largest_hole * mask.size
    small[0] = False
    return mask | small[labels]


def _honouring(mask: Mask, cells: NDArray[np.int_], positive: NDArray[np.bool_]) -> Mask:
    """The mask with each point's own pixel as the point says."""
    result = mask.copy()
    result[cells[:, 1], cells[:, 0]] = positive
    return result
