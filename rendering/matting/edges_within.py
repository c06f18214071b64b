"""Where the edge of a part lies within one colour, with no line there: a mask that has left out a piece of its part.

Across the edge of a part the colour changes, or a line is drawn. A stretch of the edge where neither is, with both on
most of the rest, shows where the mask was cut short, or goes too far: what lies beyond tears off when the part moves.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import as_uint8, is_transparent, over, window_around
from .part_meshes import shown_part

__all__ = ["OpenEdge", "open_edges"]

Mask = NDArray[np.bool_]
Floats = NDArray[np.float32]

# Larger pictures are looked at in this size [px], in which lines of drawings are about as wide as these distances.
_LARGEST = 1600
# Across an edge, colours change within the first of these distances; what is up to the second tells the colours of both
# sides [px].
_NEAR, _BESIDE = 4, 12
# A line is the edge's own within the first distance, and darker by the third than what lies beside it up to the second
# [px, px, 8-bit Lab]. Bold outlines are wide.
_OWN, _WIDE, _LINE = 6, 24, 25.0
# With lines along so much of the edge the part is one of line art: colours that differ by less than the second are
# light and shade, or a highlight [8-bit Lab].
_LINED, _SHADED = 0.75, 26.0
_SAME = 8.0  # elsewhere, colours that differ by less are the same, in texture too [8-bit Lab]
_DARK = 60.0  # in what is darker neither line nor edge would show [8-bit Lab]
# Stretches shorter than this are an accident, and interruptions up to the second do not end one [px].
_SHORTEST, _GAP = 14, 3
_MARGIN = _WIDE + 8  # nothing beyond this counts, and there is room for the edge to be smoothed [px]
_ALONG = 2  # colours are averaged over so many pixels to both sides along the edge


@dataclass(frozen=True, eq=False)
class OpenEdge:
    """A stretch of a part's edge within one colour.

    Attributes:
        points: x and y along it [px], shape [k, 2].
        length: of it [px].
    """

    points: Floats
    length: float


@dataclass(frozen=True, eq=False)
class _Outline:
    """The pixels of all long outlines behind one another.

    Attributes:
        cells: column and row, shape [n, 2].
        normals: of unit length, into the part, shape [n, 2].
        ends: where each outline begins and ends.
    """

    cells: NDArray[np.int32]
    normals: Floats
    ends: list[tuple[int, int]]


def open_edges(image: NDArray[Any], mask: NDArray[Any], *, elsewhere: Mask | None = None) -> list[OpenEdge]:
    """Where the edge of a part, as the renderer cuts it out, lies within one colour; longest first.

    The border of the picture is no edge.

    Args:
        image: RGB or straight RGBA, uint8 or float32 in 0 to 1, shape [h, w, 3] or [h, w, 4].
        mask: soft mask in 0 to 1, shape [h, w].
        elsewhere: what covers the part or moves itself, shape [h, w]: along it nothing is said.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.matting import open_edges
        >>> picture = np.full((100, 100, 3), 230, np.uint8)
        >>> picture[20:80, 20:80] = (200, 60, 40)
        >>> mask = np.zeros((100, 100), np.float32)
        >>> mask[20:80, 20:50] = 1
        >>> [edge.points.mean(axis=0).round().tolist() for edge in open_edges(picture, mask)]
        [[50.0, 50.0]]
    """
    shown = shown_part(image, mask)
    planes, inside, window, scale = _looked_at(image, shown)
    depth = _depth(inside)
    found = _outline_of(inside, depth)
    if found is None:
        return []
    is_open = _is_open(planes, depth, found)
    if elsewhere is not None:
        covers = _resized(elsewhere.astype(np.uint8), scale, cv2.INTER_NEAREST)
        near = cv2.dilate(covers[window], np.ones((2 * _NEAR + 1,) * 2, np.uint8)) > 0
        is_open &= ~near[found.cells[:, 1], found.cells[:, 0]]
    edges, corner = [], np.array([window[1].start, window[0].start])
    for start, stop in found.ends:
        for chosen in _stretches(is_open[start:stop]):
            points = (found.cells[start + chosen] + corner + 0.5) / scale
            edges.append(OpenEdge(points.astype(np.float32), len(chosen) / scale))
    return sorted(edges, key=lambda edge: -edge.length)


def _looked_at(image: NDArray[Any], shown: Floats) -> tuple[Floats, Mask, tuple[slice, slice], float]:
    """Lab and opacity of the picture, and the part, around the part, where that is, and the size that both have."""
    scale = min(1.0, _LARGEST / max(shown.shape))
    inside = _resized(shown, scale) > 0.5
    window = window_around(inside, margin=_MARGIN)
    pixels = _resized(as_uint8(over(image)), scale)[window]
    lab = cv2.cvtColor(np.ascontiguousarray(pixels), cv2.COLOR_RGB2Lab)
    opacity = [_resized(as_uint8(image)[..., 3], scale)[window]] if is_transparent(image) else []
    return np.dstack([lab, *opacity]).astype(np.float32), inside[window], window, scale


def _resized(picture: NDArray[Any], scale: float, how: int = cv2.INTER_AREA) -> NDArray[Any]:
    height, width = picture.shape[:2]
    size = max(1, round(width * scale)), max(1, round(height * scale))
    return picture if scale == 1 else cv2.resize(picture, size, interpolation=how)


def _outline_of(inside: Mask, depth: Floats) -> _Outline | None:
    """The outlines that are long enough; None where there is none."""
    contours, _ = cv2.findContours(inside.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    long = [each[:, 0] for each in contours if len(each) >= _SHORTEST]
    if not long:
        return None
    cells, stops = np.concatenate(long), np.cumsum([len(each) for each in long]).tolist()
    smooth = cv2.GaussianBlur(depth, (0, 0), 2)
    slopes = [cv2.Sobel(smooth, cv2.CV_32F, *order)[cells[:, 1], cells[:, 0]] for order in ((1, 0), (0, 1))]
    normals = np.stack(slopes, axis=1)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-6)
    return _Outline(cells, normals, list(zip([0, *stops[:-1]], stops, strict=True)))


def _depth(inside: Mask) -> Floats:
    """Distance from the part's edge, negative outside [px]; the part goes on beyond the picture."""
    sides = [np.pad(side.astype(np.uint8), 1, mode="edge") for side in (inside, ~inside)]
    within, without = (cv2.distanceTransform(each, cv2.DIST_L2, cv2.DIST_MASK_5)[1:-1, 1:-1] for each in sides)
    return within - without


def _is_open(planes: Floats, depth: Floats, outline: _Outline) -> Mask:
    """Whether there is one colour on both sides of each pixel of the outline, shape [n]."""
    across = _averaged(_across(planes, outline, _WIDE), outline)
    near = across[:, _WIDE - _NEAR : _WIDE + _NEAR + 1]
    change = np.ptp(near, axis=1).max(axis=1)
    depths = _across(depth, outline, _NEAR)
    # Where the part, or a gap in it, is narrow, the other side is not reached.
    reached = (depths[:, 0] > _NEAR / 2) & (depths[:, -1] < -_NEAR / 2)
    height, width = depth.shape
    reached &= ((outline.cells > 1) & (outline.cells < (width - 2, height - 2))).all(axis=1)
    light, first, last = across[..., 0], _WIDE - _OWN, _WIDE + _OWN + 1
    beside = np.minimum(light[:, :first].max(axis=1), light[:, last:].max(axis=1))
    lined = light[:, first:last].min(axis=1) < beside - _LINE
    reached &= near[..., 0].max(axis=1) > _DARK
    if lined.mean() >= _LINED:
        return reached & (change < _SHADED)
    inner, outer = (slice(_WIDE + side, _WIDE + side + _BESIDE - _NEAR) for side in (-_BESIDE, _NEAR + 1))
    sides = across[:, inner].mean(axis=1) - across[:, outer].mean(axis=1)
    return reached & ~lined & (change < _SAME) & (np.abs(sides).max(axis=1) < _SAME)


def _across(planes: Floats, outline: _Outline, reach: int) -> Floats:
    """What planes hold from inside to outside of each pixel of the outline, shape [n, 2 * reach + 1, ...]."""
    steps = np.arange(-reach, reach + 1, dtype=np.float32)
    at = outline.cells[:, None].astype(np.float32) - steps[:, None] * outline.normals[:, None]
    x, y = np.ascontiguousarray(at[..., 0]), np.ascontiguousarray(at[..., 1])
    rows = 1 << 14  # OpenCV takes no more than 32767 at once
    parts = [
        cv2.remap(
            planes, x[start : start + rows], y[start : start + rows], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
        )
        for start in range(0, len(x), rows)
    ]
    return np.concatenate(parts)


def _averaged(values: Floats, outline: _Outline) -> Floats:
    """Means over a few neighbours along each outline, which is closed."""
    total = values.copy()
    for start, stop in outline.ends:
        places = np.arange(stop - start)
        for step in (*range(-_ALONG, 0), *range(1, _ALONG + 1)):
            total[start:stop] += values[start + (places + step) % len(places)]
    return total / np.float32(2 * _ALONG + 1)


def _stretches(is_open: Mask) -> list[NDArray[np.int_]]:
    """Places of the long enough stretches of a closed outline."""
    count = len(is_open)
    if is_open.all():
        return [np.arange(count)]
    first = int(np.argmin(is_open))
    row = np.roll(is_open, -first).astype(np.uint8)[None]
    row = cv2.morphologyEx(row, cv2.MORPH_CLOSE, np.ones((1, 2 * _GAP + 1), np.uint8), borderValue=0)[0]
    changes = np.diff(row.astype(np.int8), prepend=0, append=0)
    pairs = zip(np.flatnonzero(changes == 1), np.flatnonzero(changes == -1), strict=True)
    return [(np.arange(start, stop) + first) % count for start, stop in pairs if stop - start >= _SHORTEST]
