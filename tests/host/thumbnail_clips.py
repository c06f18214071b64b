"""Clips of thumbnails: cut, put side by side, and with signs drawn on them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = [
    "COUNT",
    "INK",
    "LIGHT",
    "SIZE",
    "Clip",
    "Picture",
    "arrow",
    "badged",
    "bars",
    "beside",
    "closer",
    "evenly",
    "grid",
    "put",
    "round_and_round",
    "sized",
]

Picture = NDArray[np.uint8]
Clip = list[Picture]

SIZE, COUNT = (640, 360), 24
"""Pixels and frames of a clip."""
INK, LIGHT = (32, 32, 38), (250, 250, 250)
_BLUE, _PALE = (41, 121, 255), (205, 210, 220)


def sized(picture: NDArray[Any], size: tuple[int, int] = SIZE) -> Picture:
    """Any picture as RGB of a size, whatever stands over cut off at both sides."""
    if picture.dtype != np.uint8:
        picture = (np.clip(picture, 0, 1) * 255).astype(np.uint8)
    if picture.ndim == 2:
        picture = np.repeat(picture[..., None], 3, axis=2)
    scale = max(size[0] / picture.shape[1], size[1] / picture.shape[0])
    width, height = round(picture.shape[1] * scale), round(picture.shape[0] * scale)
    grown = cv2.resize(np.ascontiguousarray(picture[..., :3]), (width, height), interpolation=cv2.INTER_AREA)
    left, top = (width - size[0]) // 2, (height - size[1]) // 2
    return grown[top : top + size[1], left : left + size[0]]


def evenly(pictures: Any) -> Clip:
    """So many of them, at even distances."""
    found = list(pictures)
    return [sized(found[round(k * len(found) / COUNT)]) for k in range(COUNT)]


def beside(*clips: Clip, same: bool = False) -> Clip:
    """Slanted strips, one of each clip, with a light line between them; the same part of each, or as they lie."""
    across, slant = SIZE[0] / len(clips), 60
    if same:
        hair = 0.55 * SIZE[0]
        clips = tuple(
            [np.roll(picture, round((number + 0.5) * across - hair), axis=1) for picture in clip]
            for number, clip in enumerate(clips)
        )
    shown = [picture.copy() for picture in clips[0]]
    for number, clip in enumerate(clips[1:], start=1):
        top, foot = round(number * across + slant / 2), round(number * across - slant / 2)
        corners = np.array([(top, 0), (SIZE[0], 0), (SIZE[0], SIZE[1]), (foot, SIZE[1])], dtype=np.int32)
        where = np.zeros(SIZE[::-1], dtype=np.uint8)
        cv2.fillPoly(where, [corners], 255)
        for picture, other in zip(shown, clip, strict=True):
            picture[where > 0] = other[where > 0]
            cv2.line(picture, (top, 0), (foot, SIZE[1]), LIGHT, 4, cv2.LINE_AA)
    return shown


def grid(clips: Sequence[Clip]) -> Clip:
    """Four clips, two beside two."""
    small = [[sized(picture, (SIZE[0] // 2 - 2, SIZE[1] // 2 - 2)) for picture in clip] for clip in clips]
    shown = []
    for pictures in zip(*small, strict=True):
        sheet = np.full((SIZE[1], SIZE[0], 3), 255, dtype=np.uint8)
        for number, picture in enumerate(pictures):
            x, y = (number % 2) * (SIZE[0] // 2 + 1), (number // 2) * (SIZE[1] // 2 + 1)
            sheet[y : y + picture.shape[0], x : x + picture.shape[1]] = picture
        shown.append(sheet)
    return shown


def closer(clip: Clip, x: float, y: float, part: float) -> Clip:
    """A closer look: so large a part of the pictures, from a corner of its own."""
    width, height = round(SIZE[0] * part), round(SIZE[1] * part)
    left, top = round(SIZE[0] * x), round(SIZE[1] * y)
    return [sized(picture[top : top + height, left : left + width]) for picture in clip]


def badged(clip: Clip, draw: Callable[[Picture], None]) -> Clip:
    """The clip with a sign drawn on every picture."""
    for picture in clip:
        draw(picture)
    return clip


def put(sheet: Picture, pixels: NDArray[Any], x: int, y: int, width: int, height: int) -> None:
    """A picture with transparency in a box, as large as goes in."""
    pixels = (pixels // 257).astype(np.uint8) if pixels.dtype == np.uint16 else pixels
    scale = min(width / pixels.shape[1], height / pixels.shape[0])
    size = max(1, round(pixels.shape[1] * scale)), max(1, round(pixels.shape[0] * scale))
    small = cv2.resize(pixels, size, interpolation=cv2.INTER_AREA).astype(np.float32)
    left, top = x + (width - size[0]) // 2, y + (height - size[1]) // 2
    place = sheet[top : top + size[1], left : left + size[0]]
    alpha = small[..., 3:] / 255
    place[:] = np.rint(place * (1 - alpha) + small[..., :3] * alpha)


def arrow(picture: Picture, way: NDArray[Any], strength: float) -> None:
    """Where the stroke goes, as thick as it is strong."""
    middle = np.array((SIZE[0] - 110, SIZE[1] - 90))
    start, end = (tuple(int(v) for v in middle + sign * 64 * way) for sign in (-1, 1))
    for colour, more in ((LIGHT, 10), (_BLUE, 0)):
        cv2.arrowedLine(picture, start, end, colour, round(5 * strength) + more, cv2.LINE_AA, tipLength=0.4)


def bars(picture: Picture, full: int) -> None:
    cv2.rectangle(picture, (SIZE[0] - 190, SIZE[1] - 150), (SIZE[0] - 24, SIZE[1] - 24), LIGHT, -1)
    for number in range(4):
        x, foot = SIZE[0] - 176 + number * 36, SIZE[1] - 36
        colour = _BLUE if number < full else _PALE
        cv2.rectangle(picture, (x, foot - 24 * (number + 1)), (x + 26, foot), colour, -1)


def round_and_round(shown: Clip) -> Clip:
    """With an arrow that goes round once in the time of the loop."""
    for number, picture in enumerate(shown):
        centre, angle = (SIZE[0] - 62, SIZE[1] - 62), 360 * number / COUNT - 90
        cv2.circle(picture, centre, 44, INK, -1, cv2.LINE_AA)
        cv2.ellipse(picture, centre, (28, 28), 0, angle, angle + 290, LIGHT, 7, cv2.LINE_AA)
        tip = np.deg2rad(angle + 290)
        at = np.array(centre) + 28 * np.array([np.cos(tip), np.sin(tip)])
        ahead, aside = np.array([-np.sin(tip), np.cos(tip)]), np.array([np.cos(tip), np.sin(tip)])
        head = np.array([at + 18 * ahead, at + 13 * aside, at - 13 * aside])
        cv2.fillPoly(picture, [np.rint(head).astype(np.int32)], LIGHT, cv2.LINE_AA)
    return shown
