"""What lies across a strap, a belt or an arm from a cut, and looks as if it belonged to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import as_uint8, nearest_pixels
from .noise import LEAST_NOISE, noise_of, without_noise

__all__ = ["Beyond", "parts_beyond"]

Mask = NDArray[np.bool_]

_LARGEST = 640  # longest side at which is looked [px]
# What crosses a part is this wide, as a share of the longer side, and no narrower than this [px].
_WIDEST, _NARROWEST = 0.08, 3
# Colours on both sides differ by less: lightness more than the two others [8-bit Lab].
_ALIKE = (24, 9, 9)
# What lies beyond is at least this share of the cut, along at least this share of its own width,
_LEAST, _FACING = 0.1, 0.4
# at a distance whose middle half lies within this share of its median.
_EVEN = 0.6
_AROUND = (9, 9)  # over which colours are averaged [px]
_MOST = 8  # areas that are looked at, largest first
_BACKDROP = 0.15  # of the picture's border: what lies along so much of it is no part


@dataclass(frozen=True)
class Beyond:
    """Something alike on the other side.

    Attributes:
        x: of its middle [px].
        y: of its middle [px].
        area: of it [px^2].
    """

    x: int
    y: int
    area: int


def parts_beyond(image: NDArray[Any], mask: Mask, *, beside: NDArray[np.int_] | None = None) -> list[Beyond]:
    """Areas of the colours of a cut that lie across something narrow from it, largest first.

    Args:
        image: RGB, uint8 or float in 0..1, shape [h, w, 3].
        mask: the cut, shape [h, w].
        beside: columns and rows of points that were said to lie beside the part, shape [k, 2]: areas with one are none.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.segmentation.parts_beyond import parts_beyond
        >>> picture = np.full((120, 200, 3), 240, np.uint8)
        >>> picture[30:90, 30:170] = (60, 90, 160)
        >>> picture[:, 90:100] = (90, 50, 20)
        >>> mask = np.zeros((120, 200), bool)
        >>> mask[30:90, 30:90] = True
        >>> [each.x > 100 for each in parts_beyond(picture, mask)]
        [True]
    """
    height, width = mask.shape
    scale = min(1.0, _LARGEST / max(height, width))
    size = max(1, round(width * scale)), max(1, round(height * scale))
    lab = cv2.cvtColor(cv2.resize(as_uint8(image), size, interpolation=cv2.INTER_AREA), cv2.COLOR_RGB2Lab)
    cut = cv2.resize(mask.astype(np.float32), size, interpolation=cv2.INTER_AREA) > 0.5
    core = cv2.erode(cut.astype(np.uint8), np.ones((5, 5), np.uint8), borderValue=1) > 0
    if not core.any() or cut.all():
        return []
    noise = noise_of(lab)
    lab = cv2.medianBlur(without_noise(lab, noise), 3 if noise < LEAST_NOISE else 5)
    _, nearest = nearest_pixels(core)
    own = _means(lab, core).reshape(-1, 3)[nearest]
    alike = (np.abs(lab - own) <= _ALIKE).all(axis=2) & ~cut
    said = np.zeros(0, int)
    alike = cv2.morphologyEx(alike.astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    gap = cv2.distanceTransform((~cut).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    _, labels, boxes, _ = cv2.connectedComponentsWithStats(alike, connectivity=4)
    sizes = boxes[1:, cv2.CC_STAT_AREA]
    large = [each for each in np.argsort(-sizes)[:_MOST] if sizes[each] >= _LEAST * np.count_nonzero(cut)]
    if beside is not None and len(beside):
        x, y = np.clip((beside * scale).astype(int), 0, np.array(size) - 1).T
        said = labels[y, x]
    found = []
    for number in large:
        area = labels == number + 1
        if number + 1 in said:
            continue
        if _lies_across(area, gap, _WIDEST * max(size)) and _share_of_border(area) < _BACKDROP:
            inner = cv2.distanceTransform(np.pad(area, 1).astype(np.uint8), cv2.DIST_L2, 3)[1:-1, 1:-1]
            y, x = np.unravel_index(int(inner.argmax()), inner.shape)
            found.append(Beyond(int((x + 0.5) / scale), int((y + 0.5) / scale), int(area.sum() / scale**2)))
    return sorted(found, key=lambda each: -each.area)


def _means(lab: NDArray[np.uint8], core: Mask) -> NDArray[np.float32]:
    """The mean colours around the pixels of a core, without what lies beside it."""
    share = cv2.blur(core.astype(np.float32), _AROUND)
    return cv2.blur(lab * core[..., None].astype(np.float32), _AROUND) / np.maximum(share, 1e-6)[..., None]


def _lies_across(area: Mask, gap: NDArray[np.float32], widest: float) -> bool:
    """Whether an area faces the cut at an even distance, that of something narrow, along much of its width."""
    rim = area & (cv2.erode(area.astype(np.uint8), np.ones((3, 3), np.uint8), borderValue=1) == 0)
    near = gap[rim & (gap <= widest)]
    if not near.size or (least := float(np.percentile(near, 10))) < _NARROWEST:
        return False
    facing = near[near <= 1.5 * least + 2]
    low, middle, high = np.percentile(facing, (25, 50, 75))
    return bool(len(facing) >= _FACING * np.sqrt(np.count_nonzero(area)) and high - low <= _EVEN * middle)


def _share_of_border(area: Mask) -> float:
    border = np.concatenate([area[0], area[-1], area[1:-1, 0], area[1:-1, -1]])
    return float(border.mean())
