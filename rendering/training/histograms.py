"""Histograms as small pictures."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["BLACK", "GREY", "WHITE", "histogram", "write"]

Colour = tuple[int, int, int]

WHITE: Colour = (255, 255, 255)
BLACK: Colour = (30, 30, 30)
GREY: Colour = (170, 170, 170)
_BLUE: Colour = (40, 90, 200)

_WIDTH, _HEIGHT, _BINS, _FOOT, _HEAD = 384, 200, 32, 22, 22


def write(
    picture: NDArray[np.uint8], text: str, place: tuple[int, int], colour: Colour, *, scale: float = 0.36
) -> None:
    """Write a line into a picture, in place; letters that the font lacks become question marks."""
    plain = text.encode("ascii", "replace").decode()
    cv2.putText(picture, plain, place, cv2.FONT_HERSHEY_SIMPLEX, scale, colour, 1, cv2.LINE_AA)


def histogram(title: str, kept: Sequence[float], dropped: Sequence[float], *, least: float = 0.0) -> NDArray[np.uint8]:
    """How often values occur, dropped ones stacked on kept ones.

    Args:
        title: what the values are.
        kept, dropped: the values, from 0.
        least: largest value that the axis reaches at least.

    Returns:
        RGB, uint8, shape [200, 384, 3].
    """
    picture = np.full((_HEIGHT, _WIDTH, 3), WHITE, np.uint8)
    longest = max([*kept, *dropped, least, 1e-6])
    counts = [np.histogram(values, bins=_BINS, range=(0, longest))[0] for values in (kept, dropped)]
    highest = max(1, int(np.sum(counts, axis=0).max()))
    floor, step = _HEIGHT - _FOOT, _WIDTH // _BINS
    for number in range(_BINS):
        bottom = floor
        for count, colour in zip((counts[0][number], counts[1][number]), (_BLUE, GREY), strict=True):
            height = round(int(count) * (floor - _HEAD) / highest)
            if count:
                top = bottom - max(1, height)
                cv2.rectangle(picture, (number * step, top), ((number + 1) * step - 2, bottom - 1), colour, -1)
                bottom = top
    cv2.line(picture, (0, floor), (_WIDTH - 1, floor), BLACK, 1)
    write(picture, f"{title}; highest bar: {highest}", (2, 14), BLACK)
    write(picture, "0", (0, _HEIGHT - 8), BLACK)
    write(picture, f"{longest / 2:.3g}", (_WIDTH // 2 - 14, _HEIGHT - 8), BLACK)
    write(picture, f"{longest:.3g}", (_WIDTH - 40, _HEIGHT - 8), BLACK)
    return picture
