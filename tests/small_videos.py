"""Small videos with known motion, for tests of what cuts them into clips."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from physanimator.rendering.pictures import write_animation

__all__ = ["panned", "write_video"]

Frames = list[NDArray[np.uint8]]


def panned(seed: int, frames: int, step: float, *, hold: int = 1, size: tuple[int, int] = (128, 64)) -> Frames:
    """A picture of blots that passes by.

    Args:
        seed: of the picture.
        frames: how many there are.
        step: pixels from one drawing to the next, to the left; fractions are drawn.
        hold: frames for which each drawing stands.
        size: width and height [px].
    """
    width, height = size
    chance = np.random.default_rng(seed)
    noise = chance.integers(0, 255, (height, width + 400, 3)).astype(np.uint8)
    canvas = cv2.normalize(cv2.GaussianBlur(noise, (0, 0), 5), None, 30, 235, cv2.NORM_MINMAX)
    drawn = []
    for number in range(frames):
        shift = np.array([[1, 0, -step * (number // hold) - 20], [0, 1, 0]], dtype=np.float32)
        drawn.append(cv2.warpAffine(canvas, shift, size, flags=cv2.INTER_LINEAR))
    return drawn


def write_video(path: Path, *shots: Sequence[NDArray[np.uint8]], fps: float = 24, bars: int = 0) -> Path:
    """Shots one after another as a video, with black bars of some width on the left and right [px]."""
    frames = [cv2.copyMakeBorder(each, 0, 0, bars, bars, cv2.BORDER_CONSTANT) for shot in shots for each in shot]
    write_animation(frames, path, fps)
    return path
