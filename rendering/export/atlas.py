"""Pictures packed into few larger ones, as game engines load them: a texture atlas in Spine's text format.

Source: http://esotericsoftware.com/spine-atlas-format
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["AtlasPage", "atlas_text", "packed"]

Pixels = NDArray[np.uint8]

_SIDE = 4096  # px of a page, unless a single picture is larger
_EDGE = 2  # px by which the border of each picture is repeated around it, so that none shows in another


@dataclass(frozen=True, eq=False)
class AtlasPage:
    """One packed picture.

    Attributes:
        pixels: straight RGBA, uint8, shape [h, w, 4].
        boxes: left, top, width and height of each picture in it, by its name [px].
    """

    pixels: Pixels
    boxes: dict[str, tuple[int, int, int, int]]


def packed(pictures: Mapping[str, Pixels]) -> list[AtlasPage]:
    """Pack pictures in rows, the highest first.

    Args:
        pictures: straight RGBA by name.
    """
    left_over = sorted(pictures, key=lambda name: -pictures[name].shape[0])
    pages = []
    while left_over:
        boxes, left_over = _rows({name: pictures[name].shape[1::-1] for name in left_over})
        width = max(left + across for left, _, across, _ in boxes.values()) + _EDGE
        height = max(top + down for _, top, _, down in boxes.values()) + _EDGE
        pixels = np.zeros((height, width, 4), np.uint8)
        for name, (left, top, across, down) in boxes.items():
            around = np.pad(pictures[name], ((_EDGE, _EDGE), (_EDGE, _EDGE), (0, 0)), mode="edge")
            pixels[top - _EDGE : top + down + _EDGE, left - _EDGE : left + across + _EDGE] = around
        pages.append(AtlasPage(pixels, boxes))
    return pages


def _rows(sizes: Mapping[str, tuple[int, ...]]) -> tuple[dict[str, tuple[int, int, int, int]], list[str]]:
    """Boxes of the pictures that a page takes, and the names of the others.

    Args:
        sizes: width and height, the highest first.
    """
    outer = {name: (width + 2 * _EDGE, height + 2 * _EDGE) for name, (width, height) in sizes.items()}
    area = sum(width * height for width, height in outer.values())
    across = max(min(_SIDE, int(1.1 * area**0.5)), *(width for width, _ in outer.values()), 1)
    down = max(_SIDE, *(height for _, height in outer.values()))
    boxes: dict[str, tuple[int, int, int, int]] = {}
    others = []
    x = y = row = 0
    for name, (width, height) in outer.items():
        if x + width > across:
            x, y, row = 0, y + row, 0
        if y + height > down:
            others.append(name)
            continue
        boxes[name] = (x + _EDGE, y + _EDGE, *sizes[name])  # type: ignore[assignment]
        x, row = x + width, max(row, height)
    return boxes, others


def atlas_text(pages: Sequence[AtlasPage], names: Sequence[str]) -> str:
    """The text that says what is where.

    Args:
        pages: the packed pictures.
        names: of their files.
    """
    lines = []
    for page, name in zip(pages, names, strict=True):
        height, width = page.pixels.shape[:2]
        lines += [name, f"size:{width},{height}", "filter:Linear,Linear"]
        for region, box in page.boxes.items():
            lines += [region, f"bounds:{','.join(map(str, box))}"]
        lines.append("")
    return "\n".join(lines)
